// Spheres against a group of rays, in float with bounds on the rounding errors: surely hit, surely
// missed, or left to sphere_roots. Included once for each instruction set.
#if defined(RAYPICK_GROUP_SPHERES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_SPHERES_INL_H
#undef RAYPICK_GROUP_SPHERES_INL_H
#else
#define RAYPICK_GROUP_SPHERES_INL_H
#endif

#include "tracer/accel/simd/group_triangles-inl.h"

#include <glm/vec4.hpp>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What is the same for all rays of a group. With f from the centre to a ray's origin, the ray is
// nearest to the centre at t = -f.d / d.d, at the point q = f + t d, and within for half a chord of
// sqrt((r^2 - q.q) / d.d). In float (u = 2^-24), with components of f of at most F, those of t d
// are at most 1.8 F, q's are wrong by less than 32 u F, and r^2 - q.q where q is not longer than
// about r by less than E = 192 u F (r + 32 u F) + 8 u r^2.
struct GroupSphere {
    glm::vec3 centre{0.0f};
    float squared_radius = 0.0f;
    float error = 0.0f;        // of r^2 - q.q: E
    float along_error = 0.0f;  // of t |d|, and of half a chord besides E's part
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
    result.along_error = 48.0f * kUnit * (reach + radius) + kTiny;
    return result;
}

// Where a vector of rays enters and leaves a sphere, each wrong by `error` at most.
struct SphereSpan {
    RayFloats depth;  // r^2 - q.q: above 0 within
    RayFloats enter;
    RayFloats leave;
    RayFloats error;
};

HWY_INLINE SphereSpan sphere_span(const GroupSpace& space, const GroupSphere& sphere,
                                  std::size_t ray) {
    const Rays d;
    const auto dx = hn::Load(d, space.rays.direction[0].data() + ray);
    const auto dy = hn::Load(d, space.rays.direction[1].data() + ray);
    const auto dz = hn::Load(d, space.rays.direction[2].data() + ray);
    const auto fx =
        hn::Sub(hn::Load(d, space.rays.origin[0].data() + ray), hn::Set(d, sphere.centre.x));
    const auto fy =
        hn::Sub(hn::Load(d, space.rays.origin[1].data() + ray), hn::Set(d, sphere.centre.y));
    const auto fz =
        hn::Sub(hn::Load(d, space.rays.origin[2].data() + ray), hn::Set(d, sphere.centre.z));
    const auto squared = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const auto towards = hn::MulAdd(fx, dx, hn::MulAdd(fy, dy, hn::Mul(fz, dz)));
    const auto nearest = hn::Neg(hn::Div(towards, squared));
    const auto qx = hn::MulAdd(nearest, dx, fx);
    const auto qy = hn::MulAdd(nearest, dy, fy);
    const auto qz = hn::MulAdd(nearest, dz, fz);
    SphereSpan span;
    span.depth = hn::NegMulAdd(
        qx, qx, hn::NegMulAdd(qy, qy, hn::NegMulAdd(qz, qz, hn::Set(d, sphere.squared_radius))));
    const auto length = hn::Sqrt(squared);
    const auto half = hn::Sqrt(hn::Max(span.depth, hn::Zero(d)));
    const auto chord = hn::Div(half, length);
    span.enter = hn::Sub(nearest, chord);
    span.leave = hn::Add(nearest, chord);
    // Of the square root: E / half a chord, and sqrt(2 E) at most.
    const auto error = hn::Set(d, sphere.error);
    const auto of_root = hn::Min(hn::Div(error, half), hn::Sqrt(hn::Add(error, error)));
    span.error = hn::Div(hn::Add(of_root, hn::Set(d, sphere.along_error)), length);
    return span;
}

HWY_INLINE Verdict judge(const GroupSpace& space, const GroupLimits& limits,
                         const GroupSphere& sphere, const ShownSides& shown, std::size_t ray) {
    const Rays d;
    Verdict verdict;
    const SphereSpan span = sphere_span(space, sphere, ray);
    const auto error = hn::Set(d, sphere.error);
    // Arranged so that a NaN rules nothing out.
    verdict.may = ~ray_bits(hn::Lt(span.depth, hn::Neg(error))) & kAllAtOnce;
    if (verdict.may == 0) return verdict;
    const auto t_min = hn::Load(d, limits.t_min.data() + ray);
    const auto t_far = hn::Load(d, limits.t_far.data() + ray);
    const auto grow = hn::Set(d, kGrowGroup);
    const auto shrink = hn::Set(d, kShrinkGroup);
    const auto beyond = [&](const RayFloats& t) HWY_ATTR {
        return hn::Gt(hn::Sub(t, span.error), hn::Mul(t_far, grow));
    };
    const auto before = [&](const RayFloats& t) HWY_ATTR {
        return hn::Lt(hn::Add(t, span.error), hn::Mul(t_min, shrink));
    };
    const auto within = [&](const RayFloats& t) HWY_ATTR {
        return hn::And(hn::Gt(hn::Mul(hn::Sub(t, span.error), shrink), t_min),
                       hn::Lt(hn::Mul(hn::Add(t, span.error), grow), t_far));
    };
    const auto never = hn::Lt(t_min, t_min);
    const auto always = hn::Not(never);
    const auto no_enter = shown.front ? hn::Or(beyond(span.enter), before(span.enter)) : always;
    const auto no_leave = shown.back ? hn::Or(beyond(span.leave), before(span.leave)) : always;
    verdict.may &= ~ray_bits(hn::And(no_enter, no_leave));
    if (verdict.may == 0) return verdict;
    const auto deep = hn::Gt(span.depth, hn::Mul(error, hn::Set(d, 16.0f)));
    const auto enters = shown.front ? within(span.enter) : never;
    const auto gone = shown.front ? before(span.enter) : always;
    const auto leaves = shown.back ? hn::And(gone, within(span.leave)) : never;
    verdict.sure = verdict.may & ray_bits(hn::And(deep, hn::Or(enters, leaves)));
    const auto t = hn::IfThenElse(enters, span.enter, span.leave);
    verdict.from = hn::Mul(hn::Sub(t, span.error), shrink);
    verdict.to = hn::Mul(hn::Add(t, span.error), grow);
    return verdict;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
