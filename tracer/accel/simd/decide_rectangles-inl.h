// What flat_shapes.cpp says of a rectangle, for several rays at once: the same operations on
// doubles in the same order, so that not a bit differs. Included once for each instruction set.
#if defined(RAYPICK_DECIDE_RECTANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_DECIDE_RECTANGLES_INL_H
#undef RAYPICK_DECIDE_RECTANGLES_INL_H
#else
#define RAYPICK_DECIDE_RECTANGLES_INL_H
#endif

#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/double_vectors-inl.h"
#include "tracer/geometry/shapes.h"

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays with a rectangle each.
struct RectanglePairs {
    HWY_ALIGN std::array<LaneDoubles, 3> origin, direction, corner, edge_u, edge_v;

    HWY_INLINE void set(std::size_t lane, const ObjectRay& ray, const Rectangle& rectangle) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto i = static_cast<int>(k);
            origin[k][lane] = ray.origin[i];
            direction[k][lane] = ray.direction[i];
            corner[k][lane] = rectangle.corner[i];
            edge_u[k][lane] = rectangle.edge_u[i];
            edge_v[k][lane] = rectangle.edge_v[i];
        }
    }

    // Numbers, whichever, from this lane on.
    HWY_INLINE void fill_from(std::size_t lane) {
        for (; lane < kDoublesAtOnce; ++lane)
            set(lane, {glm::dvec3(0.0), glm::dvec3(1.0)}, Rectangle{});
    }
};

class RectanglesDecided {
public:
    // As of ConesDecided: there is one place, which rays enter at.
    std::uint32_t ordinary = 0;
    std::uint32_t enters_by_side = ~0u;
    std::uint32_t leaves_by_side = ~0u;
    std::uint32_t front = 0;
    HWY_ALIGN LaneDoubles enters_at, leaves_at;

    HWY_INLINE explicit RectanglesDecided(const RectanglePairs& pairs)
        : origin_(load_doubles(pairs.origin)),
          direction_(load_doubles(pairs.direction)),
          corner_(load_doubles(pairs.corner)),
          edge_u_(load_doubles(pairs.edge_u)),
          edge_v_(load_doubles(pairs.edge_v)) {
        decide();
    }

    // Rays from `first` on, all with the same rectangle.
    HWY_INLINE RectanglesDecided(const GroupRays& rays, std::size_t first,
                                 const Rectangle& rectangle)
        : origin_(load_rays(rays.origin, first)),
          direction_(load_rays(rays.direction, first)),
          corner_(all(rectangle.corner)),
          edge_u_(all(rectangle.edge_u)),
          edge_v_(all(rectangle.edge_v)) {
        decide();
    }

    // The hits at the lanes' roots; sets of lanes are masks.
    struct Hits {
        std::uint32_t front = 0;
        std::uint32_t ordinary = ~0u;
        HWY_ALIGN std::array<LaneDoubles, 2> at;  // where uv are asked for

        [[nodiscard]] glm::dvec2 uv(std::size_t lane) const { return {at[0][lane], at[1][lane]}; }
    };
    HWY_INLINE void sides_at(std::uint32_t /*leaving*/, std::uint32_t /*wanted*/,
                             Hits& hits) const {
        hits.front = front;
    }
    // As meet_within.
    HWY_INLINE void uv_at(std::uint32_t /*leaving*/, Hits& hits) const {
        const Doubles d;
        const DoubleVector3 from_corner =
            plus(minus(origin_, corner_), times(hn::Load(d, enters_at.data()), direction_));
        const DoubleVector squared_area = dot(normal_, normal_);
        const auto share = [&](const DoubleVector3& area) HWY_ATTR {
            const DoubleVector whole = hn::Div(dot(area, normal_), squared_area);
            const DoubleVector not_below =
                hn::IfThenElse(hn::Lt(whole, hn::Zero(d)), hn::Zero(d), whole);
            const DoubleVector one = hn::Set(d, 1.0);
            return hn::IfThenElse(hn::Lt(one, not_below), one, not_below);
        };
        hn::Store(share(cross(from_corner, edge_v_)), d, hits.at[0].data());
        hn::Store(share(cross(edge_u_, from_corner)), d, hits.at[1].data());
    }

private:
    HWY_INLINE static DoubleVector3 all(const glm::dvec3& v) {
        const Doubles d;
        return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
    }
    HWY_INLINE static DoubleVector3 load_rays(const std::array<GroupFloats, 3>& numbers,
                                              std::size_t first) {
        const Doubles d;
        const hn::Rebind<float, Doubles> of_float;
        const auto load = [&](const GroupFloats& along) HWY_ATTR {
            return hn::PromoteTo(d, hn::LoadU(of_float, along.data() + first));
        };
        return {load(numbers[0]), load(numbers[1]), load(numbers[2])};
    }

    // As meet_plane_of and passes_within.
    HWY_INLINE void decide() {
        const Doubles d;
        normal_ = cross(edge_u_, edge_v_);
        const DoubleVector slope = dot(normal_, direction_);
        const DoubleVector t = hn::Div(dot(normal_, minus(corner_, origin_)), slope);
        ordinary = double_bits(hn::And(hn::IsFinite(t), passes_within()));
        front = double_bits(hn::Lt(slope, hn::Zero(d)));
        hn::Store(t, d, enters_at.data());
        leaves_at.fill(std::numeric_limits<double>::quiet_NaN());
    }

    [[nodiscard]] HWY_INLINE hn::Mask<Doubles> passes_within() const {
        const Doubles d;
        const DoubleVector direction[3] = {direction_.x, direction_.y, direction_.z};
        const Shear shear(direction);
        const DoubleVector3 b = plus(corner_, edge_u_);
        const DoubleVector3 corners[4] = {corner_, b, plus(b, edge_v_), plus(corner_, edge_v_)};
        DoubleVector x[4];
        DoubleVector y[4];
        for (std::size_t i = 0; i < 4; ++i) {
            const DoubleVector3 from = minus(corners[i], origin_);
            const DoubleVector from_ray[3] = {from.x, from.y, from.z};
            const DoubleVector ahead = shear.axes.z_of(from_ray);
            x[i] = shear.across_x(from_ray, ahead);
            y[i] = shear.across_y(from_ray, ahead);
        }
        const DoubleVector zero = hn::Zero(d);
        auto left = hn::Eq(zero, zero);
        auto right = left;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t next = (i + 1) % 4;
            const DoubleVector side = hn::Sub(hn::Mul(x[next], y[i]), hn::Mul(y[next], x[i]));
            left = hn::And(left, hn::Ge(side, zero));
            right = hn::And(right, hn::Le(side, zero));
        }
        return hn::Xor(left, right);
    }

    DoubleVector3 origin_, direction_, corner_, edge_u_, edge_v_, normal_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
