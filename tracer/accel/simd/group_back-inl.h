// Rays that all end at one point, as shadow rays of a light do, backwards from there. Included once
// for each instruction set.
#if defined(RAYPICK_GROUP_BACK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_BACK_INL_H
#undef RAYPICK_GROUP_BACK_INL_H
#else
#define RAYPICK_GROUP_BACK_INL_H
#endif

#include "tracer/accel/simd/ray_group-inl.h"
#include "tracer/geometry/transform.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// With E the point, o + t d a ray, s about the t at which it is nearest to E, and r what it passes
// E by there:
//   E - r = o + s d,  so that  o + t d = (E - r) + (s - t) (-d).
// So the ray is one from E with direction -d that strays by r, and what it meets at t the other
// meets at s - t.
struct GroupBack {
    GroupRays rays;
    GroupCourse course;

    // Of the courses there can be.
    static float most_stray(float reach) {
        return (kFarthestEnd + 2.0f) * reach * kMostStray * 0x1p-24f;
    }
    static float most_slack(float reach) { return 33.0f * 0x1p-24f * kFarthestEnd * reach; }

    // Takes the mask's rays, with the limits that they have backwards. False, and nothing can be
    // said of the rest, if they don't end there or lie so that little would be gained; arranged so
    // that a NaN makes it false. `reach` is the largest coordinate of what is to be met.
    bool set(const GroupRays& forward, const GroupLimits& limits, RayMask mask,
             const glm::vec3& end, float reach, GroupLimits& back) {
        constexpr float kUnit = 0x1p-24f;
        const Rays d;
        HWY_ALIGN GroupFloats lengths;  // s
        auto longest = hn::Zero(d);
        auto stray = hn::Zero(d);
        bool fine = true;
        each_vector(mask, [&](std::size_t i, RayMask bits) HWY_ATTR {
            const auto there = ray_mask(bits);
            RayFloats way[3];
            RayFloats along[3];
            auto projected = hn::Zero(d);
            auto squared = hn::Zero(d);
            auto largest = hn::Zero(d);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto e = hn::Set(d, end[static_cast<int>(axis)]);
                way[axis] = hn::Sub(e, hn::Load(d, forward.origin[axis].data() + i));
                along[axis] = hn::Load(d, forward.direction[axis].data() + i);
                projected = hn::MulAdd(way[axis], along[axis], projected);
                squared = hn::MulAdd(along[axis], along[axis], squared);
                largest = hn::Max(largest, hn::Abs(way[axis]));
            }
            const auto s = hn::Div(projected, squared);
            auto passed = hn::Zero(d);
            for (std::size_t axis = 0; axis < 3; ++axis)
                passed = hn::Max(passed, hn::Abs(hn::NegMulAdd(s, along[axis], way[axis])));
            // What rounding does to r: u |w|, u |s d| and u |r|.
            passed = hn::MulAdd(largest, hn::Set(d, 4.0f * kUnit),
                                hn::Mul(passed, hn::Set(d, 1.0f + 8.0f * kUnit)));
            const auto t_far = hn::Load(d, limits.t_far.data() + i);
            auto good = hn::Le(t_far, hn::Mul(s, hn::Set(d, 1.0f + 16.0f * kUnit)));
            good = hn::And(good, hn::Le(s, hn::Set(d, kFarthestEnd * reach)));
            good = hn::And(good, hn::Le(passed, hn::Mul(hn::Add(s, hn::Set(d, reach)),
                                                        hn::Set(d, kMostStray * kUnit))));
            fine &= (ray_bits(good) & bits) == bits;
            hn::Store(s, d, lengths.data() + i);
            longest = hn::Max(longest, hn::IfThenElseZero(there, s));
            stray = hn::Max(stray, hn::IfThenElseZero(there, passed));
        });
        if (!fine) return false;
        rays.set_backwards(forward, end);
        course.forward = &forward;
        course.stray = hn::GetLane(hn::MaxOfLanes(d, stray));
        course.slack = 32.0f * kUnit * hn::GetLane(hn::MaxOfLanes(d, longest));
        set_limits(lengths, limits, mask, back);
        return true;
    }

private:
    // Of the reach: from farther away rounding would leave most triangles open.
    static constexpr float kFarthestEnd = 32.0f;
    static constexpr float kMostStray = 64.0f;

    void set_limits(const GroupFloats& lengths, const GroupLimits& limits, RayMask mask,
                    GroupLimits& back) const {
        const Rays d;
        const auto slack = hn::Set(d, course.slack);
        // Of rays that aren't there, too: see every_vector.
        back.t_min.fill(0.0f);
        back.t_far.fill(-std::numeric_limits<float>::infinity());
        each_vector(mask, [&](std::size_t i, RayMask) HWY_ATTR {
            const auto s = hn::Load(d, lengths.data() + i);
            const auto t_min = hn::Load(d, limits.t_min.data() + i);
            const auto t_far = hn::Load(d, limits.t_far.data() + i);
            hn::Store(hn::Sub(hn::Sub(s, t_far), slack), d, back.t_min.data() + i);
            hn::Store(hn::Add(hn::Sub(s, t_min), slack), d, back.t_far.data() + i);
        });
    }
};

// The course in a space that the map leads to.
inline GroupCourse course_in_object(GroupCourse course, const Transform& map,
                                    const GroupRays& forward) {
    double most = 0.0;
    for (int row = 0; row < 3; ++row) {
        most = std::max(most, std::abs(map.linear[0][row]) + std::abs(map.linear[1][row]) +
                                  std::abs(map.linear[2][row]));
    }
    course.forward = &forward;
    course.stray *= static_cast<float>(most) * (1.0f + 0x1p-20f);
    return course;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
