// sphere_roots and sphere_hit for several rays at once, each with a sphere of its own: the same
// operations on doubles in the same order, so that not a bit differs. Included once for each
// instruction set.
#if defined(RAYPICK_DECIDE_SPHERES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_DECIDE_SPHERES_INL_H
#undef RAYPICK_DECIDE_SPHERES_INL_H
#else
#define RAYPICK_DECIDE_SPHERES_INL_H
#endif

#include "tracer/accel/simd/double_vectors-inl.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/geometry/shapes.h"
#include "tracer/geometry/sphere_uv.h"

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays with a sphere each.
struct SpherePairs {
    HWY_ALIGN std::array<LaneDoubles, 3> origin, direction, centre;
    HWY_ALIGN LaneDoubles radius;

    HWY_INLINE void set(std::size_t lane, const ObjectRay& ray, const Sphere& sphere) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto i = static_cast<int>(k);
            origin[k][lane] = ray.origin[i];
            direction[k][lane] = ray.direction[i];
            centre[k][lane] = sphere.centre[i];
        }
        radius[lane] = sphere.radius;
    }

    // Numbers, whichever, from this lane on.
    HWY_INLINE void fill_from(std::size_t lane) {
        for (; lane < kDoublesAtOnce; ++lane)
            set(lane, {glm::dvec3(0.0), glm::dvec3(1.0)}, Sphere{});
    }
};

class SpheresDecided {
public:
    // As of ConesDecided, with nothing but a side.
    std::uint32_t ordinary = 0;
    std::uint32_t misses = 0;
    std::uint32_t enters_by_side = ~0u;
    std::uint32_t leaves_by_side = ~0u;
    HWY_ALIGN LaneDoubles enters_at, leaves_at;

    HWY_INLINE explicit SpheresDecided(const SpherePairs& pairs)
        : origin_(load_doubles(pairs.origin)),
          direction_(load_doubles(pairs.direction)),
          centre_(load_doubles(pairs.centre)),
          radius_(load_doubles(pairs.radius)) {
        const Doubles d;
        const DoubleVector zero = hn::Zero(d);
        const DoubleVector3 f = minus(origin_, centre_);
        const DoubleVector a = dot(direction_, direction_);
        const DoubleVector b = hn::Neg(dot(f, direction_));
        const DoubleVector3 closest = plus(f, times(hn::Div(b, a), direction_));
        const DoubleVector squared_radius = hn::Mul(radius_, radius_);
        const DoubleVector discriminant = hn::Sub(squared_radius, dot(closest, closest));
        const DoubleVector q = hn::Add(b, hn::CopySign(hn::Sqrt(hn::Mul(a, discriminant)), b));
        const DoubleVector c = hn::Sub(dot(f, f), squared_radius);
        const DoubleVector t0 = hn::Div(c, q);
        const DoubleVector t1 = hn::Div(q, a);
        from_ = smaller(t0, t1);
        to_ = larger(t0, t1);
        const auto meets = hn::Ge(discriminant, zero);
        ordinary = double_bits(hn::And(meets, hn::Gt(hn::Abs(q), zero)));
        misses = ~double_bits(meets);
        hn::Store(from_, d, enters_at.data());
        hn::Store(to_, d, leaves_at.data());
    }

    // The hits at the lanes' roots; sets of lanes are masks.
    struct Hits {
        std::uint32_t front = 0;
        std::uint32_t ordinary = ~0u;
        HWY_ALIGN std::array<LaneDoubles, 3> normal;  // unit length, where uv are asked for

        [[nodiscard]] glm::dvec2 uv(std::size_t lane) const {
            return sphere_uv({normal[0][lane], normal[1][lane], normal[2][lane]});
        }
    };
    // Where they hit a front, for the `wanted` lanes.
    HWY_INLINE void sides_at(std::uint32_t leaving, std::uint32_t wanted, Hits& hits) const {
        const Doubles d;
        const DoubleVector3 n = from_centre(leaving);
        const DoubleVector3 parts = times(n, direction_);
        const DoubleVector sum = hn::Add(hn::Add(parts.x, parts.y), parts.z);
        const DoubleVector3 sizes = size(parts);
        const DoubleVector most = hn::Add(hn::Add(sizes.x, sizes.y), sizes.z);
        // Dividing by the radius takes longer than all the rest. Rounding there and in the sums
        // moves a sum by less than 16 2^-53 of its parts' sizes: mostly that changes no sign.
        const auto clear = hn::And(hn::Gt(hn::Abs(sum), hn::Mul(hn::Set(d, 0x1p-48), most)),
                                   hn::Gt(most, hn::Set(d, 1e-200)));
        const DoubleVector zero = hn::Zero(d);
        hits.front = (wanted & ~double_bits(clear)) == 0
                         ? double_bits(hn::Lt(sum, zero))
                         : double_bits(hn::Lt(dot(over(n, radius_), direction_), zero));
    }
    HWY_INLINE void uv_at(std::uint32_t leaving, Hits& hits) const {
        const Doubles d;
        const DoubleVector3 unit = normalize(over(from_centre(leaving), radius_));
        hn::Store(unit.x, d, hits.normal[0].data());
        hn::Store(unit.y, d, hits.normal[1].data());
        hn::Store(unit.z, d, hits.normal[2].data());
    }

private:
    [[nodiscard]] HWY_INLINE DoubleVector3 from_centre(std::uint32_t leaving) const {
        const DoubleVector t = hn::IfThenElse(mask_of_bits(Doubles(), leaving), to_, from_);
        return minus(plus(origin_, times(t, direction_)), centre_);
    }

    DoubleVector3 origin_, direction_, centre_;
    DoubleVector radius_;
    DoubleVector from_, to_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
