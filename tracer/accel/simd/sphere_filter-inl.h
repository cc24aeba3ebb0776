// Spheres that a ray surely misses, or surely hits, several at a time: see sphere_bounds-inl.h.
// Included once for each instruction set.
#if defined(RAYPICK_SPHERE_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_SPHERE_FILTER_INL_H
#undef RAYPICK_SPHERE_FILTER_INL_H
#else
#define RAYPICK_SPHERE_FILTER_INL_H
#endif

#include "tracer/accel/leaf_elements.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/ray_verdict-inl.h"
#include "tracer/accel/simd/sphere_bounds-inl.h"
#include "tracer/accel/simd/triangle_bounds-inl.h"
#include "tracer/geometry/absolute.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class SphereFilter {
public:
    using Spheres = hn::CappedTag<float, 8>;
    static constexpr std::size_t kAtOnce = hn::MaxLanes(Spheres());
    static_assert(kAtOnce <= RayVerdict::kMost);

    // `reach` is the largest coordinate of the ray's origin and of the spheres, `rounded` says that
    // the origin was rounded to float.
    SphereFilter(const ObjectRay& ray, float t_min, float reach, bool rounded)
        : origin_(ray.origin),
          direction_(ray.direction),
          t_min_(t_min),
          rounding_(rounded ? reach : 0.0f) {
        const glm::vec3 along = absolute(direction_);
        const float steepest = std::max({along.x, along.y, along.z});
        // Beyond it products overflow, or bounds don't hold: then nothing is ruled out.
        idle_ = !(reach < 1e11f && steepest > 1e-6f && steepest < 1e6f);
    }

    // The same of a ray as it came, with nothing beyond what bounds hold for.
    explicit SphereFilter(const Ray& ray)
        : origin_(ray.origin), direction_(ray.direction), t_min_(ray.t_min) {}

    // Of as many spheres as one instruction takes at most those that the ray may hit at a t of at
    // most `limit`, as a mask. `Elements` is SetElements or LeafElements.
    template <typename Elements>
    HWY_INLINE std::uint32_t may_hit(const Elements& spheres, float limit) const {
        const std::uint32_t all = (1u << spheres.size()) - 1u;
        if (idle_) return all;
        const Spheres d;
        const SphereLanes<Floats> at = lanes(spheres);
        const SphereSpan<Spheres> span(SphereApproach<Spheres>(at), at);
        const auto grow = hn::Set(d, 1.0f + 0x1p-21f);
        const auto shrink = hn::Set(d, 1.0f - 0x1p-21f);
        // Arranged so that a NaN rules nothing out.
        const auto beside = hn::Lt(span.depth, hn::Neg(at.error));
        const auto beyond =
            hn::Gt(hn::Sub(span.enter, span.error), hn::Mul(hn::Set(d, limit), grow));
        const auto before =
            hn::Lt(hn::Add(span.leave, span.error), hn::Mul(hn::Set(d, t_min_), shrink));
        return all & ~bits(hn::Or(beside, hn::Or(beyond, before)));
    }

    // Of such spheres, which of them it hits first on a side that counts. Unless it is idle.
    template <typename Elements>
    HWY_INLINE void judge(const Elements& spheres, float limit, const ShownSides& shown,
                          RayVerdict& verdict) const {
        const Spheres d;
        const SphereLanes<Floats> at = lanes(spheres);
        const SphereApproach<Spheres> nearest(at);
        verdict.may =
            ((1u << spheres.size()) - 1u) & ~bits(hn::Lt(nearest.depth, hn::Neg(at.error)));
        if (verdict.may == 0) return;
        const SphereSpan<Spheres> span(nearest, at);
        const SphereCrossing<Spheres> crossing(span, at.error, hn::Set(d, t_min_),
                                               hn::Set(d, limit), shown.front, shown.back);
        verdict.may &= ~bits(crossing.misses);
        if (verdict.may == 0) return;
        verdict.sure = verdict.may & bits(crossing.sure);
        hn::Store(crossing.from, d, verdict.from.data());
        hn::Store(crossing.to, d, verdict.to.data());
    }

private:
    using Floats = hn::Vec<Spheres>;

    static HWY_INLINE std::uint32_t bits(const hn::Mask<Spheres>& mask) {
        return bits_of_mask(Spheres(), mask);
    }

    template <typename Elements>
    HWY_INLINE SphereLanes<Floats> lanes(const Elements& spheres) const {
        const Spheres d;
        Floats x;
        Floats y;
        Floats z;
        Floats radius;
        load(spheres, x, y, z, radius);
        SphereLanes<Floats> at;
        at.from_x = hn::Sub(hn::Set(d, origin_.x), x);
        at.from_y = hn::Sub(hn::Set(d, origin_.y), y);
        at.from_z = hn::Sub(hn::Set(d, origin_.z), z);
        at.x = hn::Set(d, direction_.x);
        at.y = hn::Set(d, direction_.y);
        at.z = hn::Set(d, direction_.z);
        at.inverse_squared = hn::Set(d, inverse_squared_);
        at.inverse_length = hn::Set(d, inverse_length_);
        const auto farthest =
            hn::Max(hn::Max(hn::Abs(at.from_x), hn::Abs(at.from_y)), hn::Abs(at.from_z));
        set_sphere_errors(d, hn::Add(farthest, hn::Set(d, rounding_)), radius, at);
        return at;
    }

    // The last one stands in for those that there aren't.
    template <typename Elements>
    static HWY_INLINE void load(const Elements& spheres, Floats& x, Floats& y, Floats& z,
                                Floats& radius) {
        const Spheres d;
        const auto row = [&](std::size_t i)
                             HWY_ATTR { return &spheres.row(std::min(i, spheres.size() - 1))->x; };
#if HWY_TARGET == HWY_SCALAR
        x = hn::Set(d, row(0)[0]);
        y = hn::Set(d, row(0)[1]);
        z = hn::Set(d, row(0)[2]);
        radius = hn::Set(d, row(0)[3]);
#else
        // Blocks of four numbers: the first four spheres', and the other four's in the second.
        const auto block = [&](std::size_t i) HWY_ATTR {
            if constexpr (kAtOnce == 8) {
                const hn::Half<Spheres> half;
                return hn::Combine(d, hn::LoadU(half, row(i + 4)), hn::LoadU(half, row(i)));
            } else {
                return hn::LoadU(d, row(i));
            }
        };
        const auto even_xy = hn::InterleaveLower(d, block(0), block(2));
        const auto even_zr = hn::InterleaveUpper(d, block(0), block(2));
        const auto odd_xy = hn::InterleaveLower(d, block(1), block(3));
        const auto odd_zr = hn::InterleaveUpper(d, block(1), block(3));
        x = hn::InterleaveLower(d, even_xy, odd_xy);
        y = hn::InterleaveUpper(d, even_xy, odd_xy);
        z = hn::InterleaveLower(d, even_zr, odd_zr);
        radius = hn::InterleaveUpper(d, even_zr, odd_zr);
#endif
    }

    glm::vec3 origin_, direction_;
    float inverse_squared_ = 1.0f / glm::dot(direction_, direction_);
    float inverse_length_ = std::sqrt(inverse_squared_);
    float t_min_;
    float rounding_ = 0.0f;
    bool idle_ = false;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
