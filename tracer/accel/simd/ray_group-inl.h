// Up to 64 rays that go the same way, as one space sees them. Included once for each instruction
// set.
#if defined(RAYPICK_RAY_GROUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_GROUP_INL_H
#undef RAYPICK_RAY_GROUP_INL_H
#else
#define RAYPICK_RAY_GROUP_INL_H
#endif

#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/wide_traversal-inl.h"
#include "tracer/geometry/shapes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::size_t kGroup = 64;
using GroupFloats = std::array<float, kGroup>;
using RayMask = std::uint64_t;  // bit i: ray i

// Up to kGroup of them.
inline RayMask first_rays(std::size_t count) {
    return count == kGroup ? ~RayMask{0} : (RayMask{1} << count) - 1;
}

// As many rays of a group as one instruction takes.
using Rays = hn::CappedTag<float, 16>;
using RayFloats = hn::Vec<Rays>;
inline constexpr std::size_t kAtOnce = hn::MaxLanes(Rays());
inline constexpr RayMask kAllAtOnce = (RayMask{1} << kAtOnce) - 1;

// Calls body(first ray, the mask's bits from there on) for each vector that has rays in the mask.
template <typename Body>
HWY_INLINE void each_vector(RayMask mask, const Body& body) {
    while (mask != 0) {
        const auto first = static_cast<std::size_t>(std::countr_zero(mask)) / kAtOnce * kAtOnce;
        body(first, (mask >> first) & kAllAtOnce);
        mask &= ~(kAllAtOnce << first);
    }
}

// The same for short work that most vectors have: where there are few, calls body for all of them,
// with no bits where there are no such rays, as it can't be foretold how many have.
template <typename Body>
HWY_INLINE void every_vector(RayMask mask, const Body& body) {
    if constexpr (kGroup / kAtOnce <= 4) {
        HWY_UNROLL(4)
        for (std::size_t first = 0; first < kGroup; first += kAtOnce)
            body(first, (mask >> first) & kAllAtOnce);
    } else {
        each_vector(mask, body);
    }
}

template <typename Body>
HWY_INLINE void each_ray(RayMask mask, const Body& body) {
    for (; mask != 0; mask &= mask - 1)
        body(static_cast<std::size_t>(std::countr_zero(mask)));
}

template <class M>
HWY_INLINE RayMask ray_bits(M mask) {
    return bits_of_mask(Rays(), mask);
}

HWY_INLINE hn::Mask<Rays> ray_mask(RayMask bits) {
    return mask_of_bits(Rays(), static_cast<std::uint32_t>(bits));
}

// Beyond it float products of three coordinates overflow.
inline constexpr float kFarthestReach = 1e11f;

// Rays in a space, component by component.
struct GroupRays {
    // Directions so flat along an axis are taken for this steep, and boxes are widened instead.
    static constexpr float kSteepest = 1e18f;

    HWY_ALIGN std::array<GroupFloats, 3> origin;
    HWY_ALIGN std::array<GroupFloats, 3> direction;
    HWY_ALIGN std::array<GroupFloats, 3> inverse;  // 1 / direction, clamped
    // What spheres ask for, of a direction d, set by measure_lengths():
    HWY_ALIGN GroupFloats inverse_squared;  // 1 / d.d
    HWY_ALIGN GroupFloats inverse_length;   // 1 / |d|

    void set(std::size_t ray, const ObjectRay& from) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<int>(axis);
            origin[axis][ray] = static_cast<float>(from.origin[i]);
            direction[axis][ray] = static_cast<float>(from.direction[i]);
        }
    }

    // The same rays the other way from `end`.
    void set_backwards(const GroupRays& rays, const glm::vec3& end) {
        const Rays d;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis].fill(end[static_cast<int>(axis)]);
            for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
                const auto reverse = [&](const GroupFloats& from, GroupFloats& to) HWY_ATTR {
                    hn::Store(hn::Neg(hn::Load(d, from.data() + i)), d, to.data() + i);
                };
                reverse(rays.direction[axis], direction[axis]);
                reverse(rays.inverse[axis], inverse[axis]);
            }
        }
    }

    static float inverse_of(float along) {
        const float exact = 1.0f / along;
        return std::abs(exact) < kSteepest ? exact : std::copysign(kSteepest, along);
    }

    // By inverse_of().
    void invert() {
        const Rays d;
        const auto steepest = hn::Set(d, kSteepest);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
                const auto along = hn::Load(d, direction[axis].data() + i);
                const auto exact = hn::Div(hn::Set(d, 1.0f), along);
                const auto fits = hn::Lt(hn::Abs(exact), steepest);
                hn::Store(hn::IfThenElse(fits, exact, hn::CopySign(steepest, along)), d,
                          inverse[axis].data() + i);
            }
        }
    }

    void measure_lengths() {
        const Rays d;
        for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
            const auto x = hn::Load(d, direction[0].data() + i);
            const auto y = hn::Load(d, direction[1].data() + i);
            const auto z = hn::Load(d, direction[2].data() + i);
            const auto squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
            const auto inverse_of_squared = hn::Div(hn::Set(d, 1.0f), squared);
            hn::Store(inverse_of_squared, d, inverse_squared.data() + i);
            hn::Store(hn::Sqrt(inverse_of_squared), d, inverse_length.data() + i);
        }
    }

    // Rays whose origin is nearer than `reach` in each coordinate and whose direction's largest
    // component is between the two; arranged so that a NaN is not.
    [[nodiscard]] RayMask within(float reach, float least, float most) const {
        const Rays d;
        // Magnitudes as numbers that NaNs are the largest of.
        const hn::RebindToSigned<Rays> bits;
        const auto bits_of = [&](float number)
                                 HWY_ATTR { return hn::BitCast(bits, hn::Set(d, number)); };
        RayMask result = 0;
        for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
            const auto largest = [&](const std::array<GroupFloats, 3>& v) HWY_ATTR {
                const auto load = [&](std::size_t axis) HWY_ATTR {
                    return hn::BitCast(bits, hn::Abs(hn::Load(d, v[axis].data() + i)));
                };
                return hn::Max(hn::Max(load(0), load(1)), load(2));
            };
            const auto steepest = largest(direction);
            const auto steep =
                hn::And(hn::Gt(steepest, bits_of(least)), hn::Lt(steepest, bits_of(most)));
            const auto fine = hn::And(steep, hn::Lt(largest(origin), bits_of(reach)));
            result |= ray_bits(hn::RebindMask(d, fine)) << i;
        }
        return result;
    }

    // The mask's rays by octant of direction; bit `axis` of the octant: negative there.
    [[nodiscard]] std::array<RayMask, 8> octants(RayMask mask) const {
        std::array<RayMask, 3> negative{};
        const Rays d;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
                const auto steep = hn::Load(d, inverse[axis].data() + i);
                negative[axis] |= ray_bits(hn::Lt(steep, hn::Zero(d))) << i;
            }
        }
        std::array<RayMask, 8> octants{};
        for (std::size_t octant = 0; octant < 8; ++octant) {
            octants[octant] = mask;
            for (std::size_t axis = 0; axis < 3; ++axis)
                octants[octant] &= ((octant >> axis) & 1) != 0 ? negative[axis] : ~negative[axis];
        }
        return octants;
    }
};

// How a group is followed: along its rays, or backwards from a point where all of them end.
struct GroupCourse {
    const GroupRays* forward = nullptr;  // the rays as they are, if they are followed backwards
    float stray = 0.0f;                  // a ray passes its origin by no more, in each coordinate
    float slack = 0.0f;                  // by so much t_min is lower than it is, and t_far higher

    [[nodiscard]] bool backwards() const { return forward != nullptr; }
};

// Intervals that hold rays which are all in one octant.
struct GroupBounds {
    std::array<float, 3> origin_low{}, origin_high{};
    std::array<float, 3> direction_low{}, direction_high{};
    std::array<float, 3> inverse_low{}, inverse_high{};
    std::array<std::size_t, 3> first{}, second{};  // the plane of a box that they meet first
    std::size_t octant = 0;
    std::array<float, 3> slop{};  // boxes are widened by it
    // As near as an origin can be to a box's first plane, and as far as it can be from the second.
    std::array<float, 3> near_origin{}, far_origin{};
    bool one_origin = false;

    // What follows from the directions, of which there is one octant, and the origins.
    // `relative_slop` is an instance's, `reach` the largest coordinate of what is to be met, and
    // `stray` what GroupCourse has of rays that go backwards. Returns the reach with the origins'.
    float set_planes(float relative_slop, float reach, const std::optional<float>& stray) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // In one octant they fall as directions rise.
            inverse_low[axis] = GroupRays::inverse_of(direction_high[axis]);
            inverse_high[axis] = GroupRays::inverse_of(direction_low[axis]);
            reach = std::max({reach, std::abs(origin_low[axis]), std::abs(origin_high[axis])});
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool negative = inverse_high[axis] < 0.0f;
            first[axis] = negative ? 3 + axis : axis;
            second[axis] = negative ? axis : 3 + axis;
            octant |= std::size_t{negative ? 1u : 0u} << axis;
            const bool flat = inverse_high[axis] >= GroupRays::kSteepest ||
                              inverse_low[axis] <= -GroupRays::kSteepest;
            slop[axis] = std::max(relative_slop, flat ? 0x1p-20f : kDoubleSlop) * reach;
            // More than what rounding takes away where it is added to an origin or a plane.
            if (stray) slop[axis] += *stray + 4.0f * 0x1p-24f * reach;
            const float least = origin_low[axis] - slop[axis];
            const float most = origin_high[axis] + slop[axis];
            near_origin[axis] = negative ? least : most;
            far_origin[axis] = negative ? most : least;
        }
        return reach;
    }
};

// Some of these rays, all in one octant, and the intervals that hold them.
struct GroupSpace : GroupBounds {
    const GroupRays& rays;
    const GroupCourse course;
    float steepest_direction = 0.0f;  // the largest component
    // The largest coordinate that origins were rounded from, or one whose rounding moves them as
    // far as they may stray; or 0.
    float origin_rounding = 0.0f;
    float forward_rounding = 0.0f;  // the same of the rays as they are, where these go backwards

    // `relative_slop` is the instance's; `reach` the largest coordinate of what is to be met.
    GroupSpace(const GroupRays& group, RayMask mask, float relative_slop, float reach,
               const GroupCourse& how = {})
        : rays(group), course(how) {
        measure_origins(mask);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float& low = direction_low[axis];
            float& high = direction_high[axis];
            measure(rays.direction[axis], mask, low, high);
            steepest_direction = std::max({steepest_direction, std::abs(low), std::abs(high)});
        }
        std::optional<float> stray;
        if (course.backwards()) stray = course.stray;
        reach = set_planes(relative_slop, reach, stray);
        constexpr float kUnit = 0x1p-24f;
        forward_rounding = relative_slop > 0.0f ? reach : 0.0f;
        origin_rounding = forward_rounding + course.stray / (6.0f * kUnit);
    }

    // Below every t of interest.
    [[nodiscard]] float t_least() const { return -2.0f * course.slack; }

private:
    void measure_origins(RayMask mask) {
        const auto some = static_cast<std::size_t>(std::countr_zero(mask));
        for (std::size_t axis = 0; axis < 3; ++axis)
            origin_low[axis] = rays.origin[axis][some];
        const Rays d;
        RayMask elsewhere = 0;
        every_vector(mask, [&](std::size_t i, RayMask bits) HWY_ATTR {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto origin = hn::Load(d, rays.origin[axis].data() + i);
                elsewhere |= bits & ~ray_bits(hn::Eq(origin, hn::Set(d, origin_low[axis])));
            }
        });
        origin_high = origin_low;
        one_origin = elsewhere == 0;
        if (one_origin) return;
        for (std::size_t axis = 0; axis < 3; ++axis)
            measure(rays.origin[axis], mask, origin_low[axis], origin_high[axis]);
    }

    static void measure(const GroupFloats& numbers, RayMask mask, float& low, float& high) {
        const Rays d;
        auto least = hn::Set(d, std::numeric_limits<float>::infinity());
        auto most = hn::Neg(least);
        every_vector(mask, [&](std::size_t i, RayMask bits) HWY_ATTR {
            const auto there = ray_mask(bits);
            const auto some = hn::Load(d, numbers.data() + i);
            least = hn::Min(least, hn::IfThenElse(there, some, least));
            most = hn::Max(most, hn::IfThenElse(there, some, most));
        });
        low = hn::GetLane(hn::MinOfLanes(d, least));
        high = hn::GetLane(hn::MaxOfLanes(d, most));
    }
};

// How far each ray of a group is to be followed.
struct GroupLimits {
    HWY_ALIGN GroupFloats t_min;
    HWY_ALIGN GroupFloats t_far;  // shrinks as hits are found; -infinity: no further
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
