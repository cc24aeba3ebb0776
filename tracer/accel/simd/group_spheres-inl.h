// Spheres against a group of rays, in float with bounds on the rounding errors: surely hit, surely
// missed, or left to sphere_roots. Included once for each instruction set.
#if defined(RAYPICK_GROUP_SPHERES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_SPHERES_INL_H
#undef RAYPICK_GROUP_SPHERES_INL_H
#else
#define RAYPICK_GROUP_SPHERES_INL_H
#endif

#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/sphere_bounds-inl.h"

#include <glm/vec4.hpp>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What is the same for all rays of a group; the errors as SphereLanes has them.
struct GroupSphere {
    using Set = SphereSet;

    glm::vec3 centre{0.0f};
    float squared_radius = 0.0f;
    float error = 0.0f;
    float root_error = 0.0f;
    float along_error = 0.0f;
};

inline GroupSphere group_sphere(const GroupSpace& space, const glm::vec4& sphere) {
    constexpr float kUnit = 0x1p-24f;
    constexpr float kTiny = 16.0f * std::numeric_limits<float>::min();
    GroupSphere result;
    result.centre = glm::vec3(sphere);
    const float radius = sphere.w;
    result.squared_radius = radius * radius;
    const glm::vec3 low(space.origin_low[0], space.origin_low[1], space.origin_low[2]);
    const glm::vec3 high(space.origin_high[0], space.origin_high[1], space.origin_high[2]);
    const float reach =
        std::max(largest_of(result.centre - low), largest_of(result.centre - high)) +
        space.origin_rounding;
    result.error = 192.0f * kUnit * reach * (radius + 32.0f * kUnit * reach) +
                   8.0f * kUnit * result.squared_radius + kTiny;
    result.root_error = std::sqrt(result.error + result.error);
    result.along_error = 48.0f * kUnit * (reach + radius) + kTiny;
    return result;
}

HWY_INLINE SphereLanes<hn::Vec<Rays>> sphere_lanes(const GroupSpace& space,
                                                   const GroupSphere& sphere, std::size_t ray) {
    const Rays d;
    const auto load = [&](const GroupFloats& numbers)
                          HWY_ATTR { return hn::Load(d, numbers.data() + ray); };
    const GroupRays& rays = space.rays;
    return {hn::Sub(load(rays.origin[0]), hn::Set(d, sphere.centre.x)),
            hn::Sub(load(rays.origin[1]), hn::Set(d, sphere.centre.y)),
            hn::Sub(load(rays.origin[2]), hn::Set(d, sphere.centre.z)),
            load(rays.direction[0]),
            load(rays.direction[1]),
            load(rays.direction[2]),
            load(rays.inverse_squared),
            load(rays.inverse_length),
            hn::Set(d, sphere.squared_radius),
            hn::Set(d, sphere.error),
            hn::Set(d, sphere.root_error),
            hn::Set(d, sphere.along_error)};
}

HWY_INLINE Verdict judge(const GroupSpace& space, const GroupLimits& limits,
                         const GroupSphere& sphere, const ShownSides& shown, std::size_t ray) {
    const Rays d;
    Verdict verdict;
    const SphereLanes<hn::Vec<Rays>> lanes = sphere_lanes(space, sphere, ray);
    const SphereApproach<Rays> nearest(lanes);
    // Arranged so that a NaN rules nothing out.
    verdict.may = ~ray_bits(hn::Lt(nearest.depth, hn::Neg(lanes.error))) & kAllAtOnce;
    if (verdict.may == 0) return verdict;
    const SphereSpan<Rays> span(nearest, lanes);
    const SphereCrossing<Rays> crossing(span, lanes.error, hn::Load(d, limits.t_min.data() + ray),
                                        hn::Load(d, limits.t_far.data() + ray), shown.front,
                                        shown.back);
    verdict.may &= ~ray_bits(crossing.misses);
    if (verdict.may == 0) return verdict;
    verdict.sure = verdict.may & ray_bits(crossing.sure);
    verdict.from = crossing.from;
    verdict.to = crossing.to;
    return verdict;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
