// Cones against a group of rays: see cone_bounds-inl.h. Included once for each instruction set.
#if defined(RAYPICK_GROUP_CONES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_CONES_INL_H
#undef RAYPICK_GROUP_CONES_INL_H
#else
#define RAYPICK_GROUP_CONES_INL_H
#endif

#include "tracer/accel/simd/cone_bounds-inl.h"
#include "tracer/accel/simd/group_spheres-inl.h"
#include "tracer/accel/simd/group_triangles-inl.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What is the same for all rays of a group.
struct GroupCone {
    using Set = ConeSet;

    glm::vec3 base{0.0f};
    glm::vec3 axis{0.0f};
    float length = 0.0f;
    float radius = 0.0f;
    float widening = 0.0f;
    float widest = 0.0f;
    bool capped = false;
};

inline GroupCone group_cone(const glm::vec4& base, const glm::vec4& apex, bool capped) {
    const glm::dvec3 axis = glm::dvec3(apex) - glm::dvec3(base);
    const double length = glm::length(axis);
    const double widening = (static_cast<double>(apex.w) - static_cast<double>(base.w)) / length;
    return {glm::vec3(base), glm::vec3(axis / length),     static_cast<float>(length),
            base.w,          static_cast<float>(widening), std::max(base.w, apex.w),
            capped};
}

HWY_INLINE ConeLanes<RayFloats> lanes_of(const GroupCone& cone, float rounding) {
    const Rays d;
    return {hn::Set(d, cone.base.x), hn::Set(d, cone.base.y), hn::Set(d, cone.base.z),
            hn::Set(d, cone.axis.x), hn::Set(d, cone.axis.y), hn::Set(d, cone.axis.z),
            hn::Set(d, cone.length), hn::Set(d, cone.radius), hn::Set(d, cone.widening),
            hn::Set(d, cone.widest), hn::Set(d, rounding)};
}

HWY_INLINE RayLanes<RayFloats> lanes_of(const GroupSpace& space, const GroupLimits& limits,
                                        std::size_t ray) {
    const Rays d;
    const auto load = [&](const GroupFloats& numbers)
                          HWY_ATTR { return hn::Load(d, numbers.data() + ray); };
    return {load(space.rays.origin[0]),
            load(space.rays.origin[1]),
            load(space.rays.origin[2]),
            load(space.rays.direction[0]),
            load(space.rays.direction[1]),
            load(space.rays.direction[2]),
            hn::Set(d, space.steepest_direction),
            load(limits.t_min),
            load(limits.t_far)};
}

// `bits` are the rays that matter.
HWY_INLINE Verdict judge_cone(const RayLanes<RayFloats>& rays, float rounding,
                              const GroupCone& cone, const ShownSides& shown, RayMask bits) {
    const ConeLanes<RayFloats> cones = lanes_of(cone, rounding);
    ConeBounds<Rays> bounds(cones, rays);
    Verdict verdict;
    verdict.may = ~ray_bits(bounds.passes_by()) & bits;
    if (verdict.may == 0) return verdict;
    bounds.estimate();
    verdict.may &= ~ray_bits(bounds.misses());
    if (verdict.may == 0) return verdict;
    const auto crossing = bounds.crossing(shown.front, shown.back, cone.capped);
    verdict.sure = verdict.may & ray_bits(crossing.sure);
    verdict.from = crossing.from;
    verdict.to = crossing.to;
    return verdict;
}

HWY_INLINE Verdict judge_some(const GroupSpace& space, const GroupLimits& limits,
                              const GroupCone& cone, const ShownSides& shown, std::size_t ray,
                              RayMask bits) {
    return judge_cone(lanes_of(space, limits, ray), space.origin_rounding, cone, shown, bits);
}

// The same of other shapes.
template <typename Prepared>
HWY_INLINE Verdict judge_some(const GroupSpace& space, const GroupLimits& limits,
                              const Prepared& shape, const ShownSides& shown, std::size_t ray,
                              RayMask /*bits*/) {
    return judge(space, limits, shape, shown, ray);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
