// cone_roots, cone_normal and cone_uv for several rays at once, each with a cone of its own: the
// same operations on doubles in the same order, so that not a bit differs. Included once for each
// instruction set.
#if defined(RAYPICK_DECIDE_CONES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_DECIDE_CONES_INL_H
#undef RAYPICK_DECIDE_CONES_INL_H
#else
#define RAYPICK_DECIDE_CONES_INL_H
#endif

#include "tracer/accel/simd/double_vectors-inl.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/geometry/axis_frame.h"
#include "tracer/geometry/shapes.h"

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays with a cone each.
struct ConePairs {
    HWY_ALIGN std::array<LaneDoubles, 3> origin, direction, base, apex;
    HWY_ALIGN LaneDoubles base_radius, apex_radius;

    HWY_INLINE void set(std::size_t lane, const ObjectRay& ray, const Cone& cone) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto i = static_cast<int>(k);
            origin[k][lane] = ray.origin[i];
            direction[k][lane] = ray.direction[i];
            base[k][lane] = cone.base[i];
            apex[k][lane] = cone.apex[i];
        }
        base_radius[lane] = cone.base_radius;
        apex_radius[lane] = cone.apex_radius;
    }

    // Numbers, whichever, from this lane on.
    HWY_INLINE void fill_from(std::size_t lane) {
        const Cone cone;
        for (; lane < kDoublesAtOnce; ++lane)
            set(lane, {glm::dvec3(0.0), glm::dvec3(1.0)}, cone);
    }
};

class ConesDecided {
public:
    // Of each lane where the ray enters and leaves the body, and whether by the side; as masks.
    // `ordinary` are those that hit and that no special case of cone_roots concerns: what is said
    // of the others means nothing, but that those in `misses` miss. Of cones these aren't told
    // apart.
    std::uint32_t ordinary = 0;
    std::uint32_t misses = 0;
    std::uint32_t enters_by_side = 0;
    std::uint32_t leaves_by_side = 0;
    HWY_ALIGN LaneDoubles enters_at, leaves_at;  // t

    HWY_INLINE explicit ConesDecided(const ConePairs& pairs) {
        const Doubles d;
        const DoubleVector3 base = load_doubles(pairs.base);
        const DoubleVector3 apex = load_doubles(pairs.apex);
        const DoubleVector3 origin = load_doubles(pairs.origin);
        const DoubleVector base_radius = load_doubles(pairs.base_radius);
        const DoubleVector apex_radius = load_doubles(pairs.apex_radius);
        direction_ = load_doubles(pairs.direction);
        const DoubleVector3 raw_axis = minus(apex, base);
        length_ = length(raw_axis);
        axis_ = over(raw_axis, length_);
        widening_ = hn::Div(hn::Sub(apex_radius, base_radius), length_);
        const DoubleVector half = hn::Set(d, 0.5);
        const DoubleVector3 middle = plus(times(half, base), times(half, apex));
        start_ = hn::Div(dot(minus(middle, origin), direction_), dot(direction_, direction_));
        const DoubleVector3 p = plus(minus(origin, base), times(start_, direction_));
        height_ = dot(p, axis_);
        climb_ = dot(direction_, axis_);
        across_ = minus(p, times(height_, axis_));
        drift_ = minus(direction_, times(climb_, axis_));
        meet(base_radius, larger(base_radius, apex_radius));
    }

    // The hits at the lanes' roots, on the side; sets of lanes are masks.
    struct Hits {
        std::uint32_t front = 0;
        std::uint32_t ordinary = 0;
        // Where uv are asked for:
        HWY_ALIGN LaneDoubles angle_x, angle_z;  // what turn() takes
        HWY_ALIGN LaneDoubles height;            // the uv's

        [[nodiscard]] glm::dvec2 uv(std::size_t lane) const {
            return {turn(angle_x[lane], angle_z[lane]), height[lane]};
        }
    };
    // Sets `front`, and `ordinary` to those that have a side.
    HWY_INLINE void sides_at(std::uint32_t leaving, std::uint32_t /*wanted*/, Hits& hits) const {
        const DoubleVector zero = hn::Zero(Doubles());
        const DoubleVector3 across = plus(across_, times(root(leaving), drift_));
        const DoubleVector distance = length(across);
        hits.ordinary = double_bits(hn::Gt(distance, zero));
        const DoubleVector3 normal = minus(over(across, distance), times(widening_, axis_));
        hits.front = double_bits(hn::Lt(dot(normal, direction_), zero));
    }
    HWY_INLINE void uv_at(std::uint32_t leaving, Hits& hits) const {
        const Doubles d;
        const DoubleVector zero = hn::Zero(d);
        const DoubleVector one = hn::Set(d, 1.0);
        const DoubleVector after = root(leaving);
        const DoubleVector3 across = plus(across_, times(after, drift_));
        const DoubleVector3 y = normalize(axis_);
        const DoubleVector3 size{hn::Abs(y.x), hn::Abs(y.y), hn::Abs(y.z)};
        const auto by_x = hn::And(hn::Le(size.x, size.y), hn::Le(size.x, size.z));
        const auto by_y = hn::AndNot(by_x, hn::Le(size.y, size.z));
        const DoubleVector3 least{hn::IfThenElseZero(by_x, one), hn::IfThenElseZero(by_y, one),
                                  hn::IfThenZeroElse(hn::Or(by_x, by_y), one)};
        const DoubleVector3 x = normalize(minus(least, times(dot(least, y), y)));
        const DoubleVector3 z{hn::Sub(hn::Mul(x.y, y.z), hn::Mul(y.y, x.z)),
                              hn::Sub(hn::Mul(x.z, y.x), hn::Mul(y.z, x.x)),
                              hn::Sub(hn::Mul(x.x, y.y), hn::Mul(y.x, x.y))};
        hn::Store(dot(across, x), d, hits.angle_x.data());
        hn::Store(dot(across, z), d, hits.angle_z.data());
        const DoubleVector share = hn::Div(hn::Add(height_, hn::Mul(after, climb_)), length_);
        const DoubleVector not_above = hn::IfThenElse(hn::Lt(one, share), one, share);
        hn::Store(hn::IfThenElse(hn::Lt(share, zero), zero, not_above), d, hits.height.data());
    }

private:
    [[nodiscard]] HWY_INLINE DoubleVector root(std::uint32_t leaving) const {
        return hn::IfThenElse(mask_of_bits(Doubles(), leaving), to_, from_);
    }

    HWY_INLINE void meet(DoubleVector base_radius, DoubleVector widest) {
        const Doubles d;
        const DoubleVector zero = hn::Zero(d);
        const DoubleVector at_base = hn::Div(hn::Neg(height_), climb_);
        const DoubleVector at_apex = hn::Div(hn::Sub(length_, height_), climb_);
        const DoubleVector slab_from = smaller(at_base, at_apex);
        const DoubleVector slab_to = larger(at_base, at_apex);
        const DoubleVector squared_drift = dot(drift_, drift_);
        const DoubleVector unbound = hn::Div(hn::Neg(dot(across_, drift_)), squared_drift);
        const DoubleVector nearest = larger(slab_from, smaller(slab_to, unbound));
        start_ = hn::Add(start_, nearest);
        height_ = hn::Add(height_, hn::Mul(nearest, climb_));
        across_ = plus(across_, times(nearest, drift_));
        const DoubleVector planes_from = hn::Sub(slab_from, nearest);
        const DoubleVector planes_to = hn::Sub(slab_to, nearest);
        const DoubleVector squared_distance = dot(across_, across_);
        const DoubleVector radius = hn::Add(base_radius, hn::Mul(widening_, height_));
        const DoubleVector growth = hn::Mul(widening_, climb_);
        const DoubleVector drift = hn::Sqrt(squared_drift);
        const DoubleVector distance = hn::Sqrt(squared_distance);
        const DoubleVector size = hn::Abs(growth);
        const DoubleVector a = hn::Mul(hn::Sub(drift, size), hn::Add(drift, size));
        const DoubleVector b = hn::Sub(dot(across_, drift_), hn::Mul(growth, radius));
        const DoubleVector c = hn::Mul(hn::Sub(distance, radius), hn::Add(distance, radius));
        const DoubleVector discriminant = hn::Sub(hn::Mul(b, b), hn::Mul(a, c));
        const DoubleVector q = hn::Neg(hn::Add(b, hn::CopySign(hn::Sqrt(discriminant), b)));
        const DoubleVector t0 = hn::Div(q, a);
        const DoubleVector t1 = hn::Div(c, q);
        const DoubleVector side_from = smaller(t0, t1);
        const DoubleVector side_to = larger(t0, t1);
        from_ = larger(planes_from, side_from);
        to_ = smaller(planes_to, side_to);
        const DoubleVector huge = hn::Set(d, 1e300);
        auto fine = hn::And(hn::Gt(hn::Abs(climb_), zero), hn::Gt(squared_drift, zero));
        fine = hn::And(fine, hn::Le(squared_distance, hn::Mul(widest, widest)));
        fine = hn::And(fine, hn::And(hn::Gt(a, zero), hn::Ge(discriminant, zero)));
        fine = hn::And(fine, hn::And(hn::Gt(hn::Abs(q), zero), hn::Le(from_, to_)));
        fine =
            hn::And(fine, hn::And(hn::Lt(hn::Abs(at_base), huge), hn::Lt(hn::Abs(at_apex), huge)));
        ordinary = double_bits(fine);
        enters_by_side = double_bits(hn::Ge(side_from, planes_from));
        leaves_by_side = double_bits(hn::Le(side_to, planes_to));
        hn::Store(hn::Add(start_, from_), d, enters_at.data());
        hn::Store(hn::Add(start_, to_), d, leaves_at.data());
    }

    DoubleVector3 direction_, axis_;
    DoubleVector length_, widening_;
    // The axial ray.
    DoubleVector start_, height_, climb_;
    DoubleVector3 across_, drift_;
    DoubleVector from_, to_;  // after start_
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
