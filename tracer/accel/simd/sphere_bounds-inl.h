// Where rays enter and leave spheres, in float with bounds on the rounding errors. Included once
// for each instruction set.
#if defined(RAYPICK_SPHERE_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_SPHERE_BOUNDS_INL_H
#undef RAYPICK_SPHERE_BOUNDS_INL_H
#else
#define RAYPICK_SPHERE_BOUNDS_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays and spheres side by side, a lane each, with what bounds the errors: see SphereApproach.
template <class V>
struct SphereLanes {
    V from_x, from_y, from_z;  // from the centre to the ray's origin
    V x, y, z;                 // the ray's direction d
    V inverse_squared;         // 1 / d.d
    V inverse_length;          // 1 / |d|
    V squared_radius;
    V error;        // of r^2 - q.q: E
    V root_error;   // sqrt(2 E)
    V along_error;  // of t |d|, and of half a chord besides E's part
};

// With f from the centre to the origin, a ray is nearest to the centre at t = -f.d / d.d, at the
// point q = f + t d, and within for half a chord of sqrt((r^2 - q.q) / d.d). In float (u = 2^-24),
// with components of f of at most F, those of t d are at most 1.8 F, q's are wrong by less than 32
// u F, and r^2 - q.q where q is not longer than about r by less than E = 192 u F (r + 32 u F) + 8 u
// r^2.
template <class D, class V = hn::Vec<D>>
struct SphereApproach {
    V t;      // of q
    V depth;  // r^2 - q.q: above 0 within

    HWY_INLINE explicit SphereApproach(const SphereLanes<V>& at) {
        const auto towards =
            hn::MulAdd(at.from_x, at.x, hn::MulAdd(at.from_y, at.y, hn::Mul(at.from_z, at.z)));
        t = hn::Neg(hn::Mul(towards, at.inverse_squared));
        const auto qx = hn::MulAdd(t, at.x, at.from_x);
        const auto qy = hn::MulAdd(t, at.y, at.from_y);
        const auto qz = hn::MulAdd(t, at.z, at.from_z);
        depth =
            hn::NegMulAdd(qx, qx, hn::NegMulAdd(qy, qy, hn::NegMulAdd(qz, qz, at.squared_radius)));
    }
};

// The same, with where the ray enters and leaves: that takes longer, and most rays pass by.
template <class D, class V = hn::Vec<D>>
struct SphereSpan {
    V depth;
    V enter;  // these two are wrong by `error` at most
    V leave;
    V error;

    HWY_INLINE SphereSpan(const SphereApproach<D>& nearest, const SphereLanes<V>& at)
        : depth(nearest.depth) {
        const D d;
        const auto half = hn::Sqrt(hn::Max(depth, hn::Zero(d)));
        const auto chord = hn::Mul(half, at.inverse_length);
        enter = hn::Sub(nearest.t, chord);
        leave = hn::Add(nearest.t, chord);
        // Of the square root: E / half a chord, and sqrt(2 E) at most.
        const auto of_root = hn::Min(hn::Div(at.error, half), at.root_error);
        error = hn::Mul(hn::Add(of_root, at.along_error), at.inverse_length);
    }
};

// What the bounds say of the first hit between t_min and t_far on a side that counts, after
// depth's error, E, let the lane through.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
struct SphereCrossing {
    M misses;
    M sure;  // that the first one lies between these
    V from, to;

    // Arranged so that a NaN neither rules anything out nor makes it sure.
    HWY_INLINE SphereCrossing(const SphereSpan<D>& span, V depth_error, V t_min, V t_far,
                              bool front, bool back) {
        const D d;
        const auto grow = hn::Set(d, 1.0f + 8.0f * 0x1p-24f);
        const auto shrink = hn::Set(d, 1.0f - 8.0f * 0x1p-24f);
        const auto beyond = [&](const V& t) HWY_ATTR {
            return hn::Gt(hn::Sub(t, span.error), hn::Mul(t_far, grow));
        };
        const auto before = [&](const V& t) HWY_ATTR {
            return hn::Lt(hn::Add(t, span.error), hn::Mul(t_min, shrink));
        };
        const auto within = [&](const V& t) HWY_ATTR {
            return hn::And(hn::Gt(hn::Mul(hn::Sub(t, span.error), shrink), t_min),
                           hn::Lt(hn::Mul(hn::Add(t, span.error), grow), t_far));
        };
        const auto never = hn::Lt(t_min, t_min);
        const auto always = hn::Not(never);
        const auto no_enter = front ? hn::Or(beyond(span.enter), before(span.enter)) : always;
        const auto no_leave = back ? hn::Or(beyond(span.leave), before(span.leave)) : always;
        misses = hn::And(no_enter, no_leave);
        const auto deep = hn::Gt(span.depth, hn::Mul(depth_error, hn::Set(d, 16.0f)));
        const auto enters = front ? within(span.enter) : never;
        const auto gone = front ? before(span.enter) : always;
        const auto leaves = back ? hn::And(gone, within(span.leave)) : never;
        sure = hn::And(deep, hn::Or(enters, leaves));
        const auto t = hn::IfThenElse(enters, span.enter, span.leave);
        from = hn::Mul(hn::Sub(t, span.error), shrink);
        to = hn::Mul(hn::Add(t, span.error), grow);
    }
};

// Of the reach F and the radius.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void set_sphere_errors(D d, V reach, V radius, SphereLanes<V>& to) {
    constexpr float kUnit = 0x1p-24f;
    const auto tiny = hn::Set(d, 16.0f * std::numeric_limits<float>::min());
    to.squared_radius = hn::Mul(radius, radius);
    const auto of_reach = hn::Mul(hn::Set(d, 192.0f * kUnit), reach);
    to.error = hn::MulAdd(of_reach, hn::MulAdd(hn::Set(d, 32.0f * kUnit), reach, radius),
                          hn::MulAdd(hn::Set(d, 8.0f * kUnit), to.squared_radius, tiny));
    to.root_error = hn::Sqrt(hn::Add(to.error, to.error));
    to.along_error = hn::MulAdd(hn::Set(d, 48.0f * kUnit), hn::Add(reach, radius), tiny);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
