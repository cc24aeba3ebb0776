// Cones that a ray surely misses, or surely hits, several at a time: see cone_bounds-inl.h.
// Included once for each instruction set.
#if defined(RAYPICK_CONE_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_CONE_FILTER_INL_H
#undef RAYPICK_CONE_FILTER_INL_H
#else
#define RAYPICK_CONE_FILTER_INL_H
#endif

#include "tracer/accel/simd/cone_bounds-inl.h"
#include "tracer/accel/simd/ray_verdict-inl.h"
#include "tracer/accel/simd/triangle_bounds-inl.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Four = hn::CappedTag<float, 4>;
using FourFloats = hn::Vec<Four>;

HWY_INLINE FourFloats four(float a, float b, float c, float d) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
    return FourFloats{__m128{a, b, c, d}};
#else
    HWY_ALIGN const float lanes[4] = {a, b, c, d};
    return hn::Load(Four(), lanes);
#endif
}

class ConeFilter {
public:
    static constexpr std::size_t kAtOnce = hn::MaxLanes(Four());
    static_assert(kAtOnce <= RayVerdict::kMost);

    // `reach` is the largest coordinate of the ray's origin and of the cones, `rounded` says that
    // the origin was rounded to float.
    ConeFilter(const ObjectRay& ray, float t_min, float reach, bool rounded)
        : origin_(ray.origin),
          direction_(ray.direction),
          t_min_(t_min),
          steepest_(
              std::max({std::abs(direction_.x), std::abs(direction_.y), std::abs(direction_.z)})),
          rounding_(rounded ? reach : 0.0f),
          // Beyond it products overflow, or bounds don't hold: then nothing is ruled out.
          idle_(!(reach < 1e11f && steepest_ > 1e-6f && steepest_ < 1e6f)) {}

    // The same of a ray as it came, with nothing beyond what bounds hold for. `steepest` is its
    // direction's largest component.
    ConeFilter(const Ray& ray, float steepest)
        : origin_(ray.origin), direction_(ray.direction), t_min_(ray.t_min), steepest_(steepest) {}

    // Of up to four cones, as a leaf has them, those that the ray may hit at a t of at most
    // `limit`, as a mask.
    HWY_INLINE std::uint32_t may_hit(const ConeSet& set, std::span<const std::uint32_t> primitives,
                                     float limit) const {
        const std::uint32_t all = (1u << primitives.size()) - 1u;
        if (idle_) return all;
        const ConeLanes<FourFloats> cones = lanes(set, primitives);
        const RayLanes<FourFloats> ray = ray_lanes(limit);
        ConeBounds<Four> bounds(cones, ray);
        const std::uint32_t left = all & ~bits(bounds.passes_by());
        if (left == 0) return 0;
        bounds.estimate();
        return left & ~bits(bounds.misses());
    }

    // Of such cones, which of them it hits first on a side that counts. Unless it is idle.
    HWY_INLINE void judge(const ConeSet& set, std::span<const std::uint32_t> primitives,
                          float limit, const ShownSides& shown, RayVerdict& verdict) const {
        const ConeLanes<FourFloats> cones = lanes(set, primitives);
        const RayLanes<FourFloats> ray = ray_lanes(limit);
        ConeBounds<Four> bounds(cones, ray);
        verdict.may = ((1u << primitives.size()) - 1u) & ~bits(bounds.passes_by());
        if (verdict.may == 0) return;
        bounds.estimate();
        verdict.may &= ~bits(bounds.misses());
        if (verdict.may == 0) return;
        const auto crossing = bounds.crossing(shown.front, shown.back, set.capped);
        verdict.sure = verdict.may & bits(crossing.sure);
        hn::Store(crossing.from, Four(), verdict.from.data());
        hn::Store(crossing.to, Four(), verdict.to.data());
    }

private:
    HWY_INLINE RayLanes<FourFloats> ray_lanes(float limit) const {
        const Four d;
        return {hn::Set(d, origin_.x),    hn::Set(d, origin_.y),    hn::Set(d, origin_.z),
                hn::Set(d, direction_.x), hn::Set(d, direction_.y), hn::Set(d, direction_.z),
                hn::Set(d, steepest_),    hn::Set(d, t_min_),       hn::Set(d, limit)};
    }

    HWY_INLINE ConeLanes<FourFloats> lanes(const ConeSet& set,
                                           std::span<const std::uint32_t> primitives) const {
        const std::size_t last = primitives.size() - 1;
        const Four d;
        const glm::vec4* ends = set.ends.data();
        const glm::vec4* c0 = ends + number(primitives[0]);
        const glm::vec4* c1 = ends + number(primitives[std::min(std::size_t{1}, last)]);
        const glm::vec4* c2 = ends + number(primitives[std::min(std::size_t{2}, last)]);
        const glm::vec4* c3 = ends + number(primitives[last]);
        ConeLanes<FourFloats> cone;
        cone.base_x = four(c0->x, c1->x, c2->x, c3->x);
        cone.base_y = four(c0->y, c1->y, c2->y, c3->y);
        cone.base_z = four(c0->z, c1->z, c2->z, c3->z);
        cone.radius = four(c0->w, c1->w, c2->w, c3->w);
        const auto x = hn::Sub(four(c0[1].x, c1[1].x, c2[1].x, c3[1].x), cone.base_x);
        const auto y = hn::Sub(four(c0[1].y, c1[1].y, c2[1].y, c3[1].y), cone.base_y);
        const auto z = hn::Sub(four(c0[1].z, c1[1].z, c2[1].z, c3[1].z), cone.base_z);
        const auto at_apex = four(c0[1].w, c1[1].w, c2[1].w, c3[1].w);
        const auto squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
        // Squares of less underflow: then comparisons with NaN rule nothing out.
        const auto fits = hn::Gt(squared, hn::Set(d, 0x1p-80f));
        cone.length = hn::IfThenElse(fits, hn::Sqrt(squared),
                                     hn::Set(d, std::numeric_limits<float>::quiet_NaN()));
        const auto one_by_length = hn::Div(hn::Set(d, 1.0f), cone.length);
        cone.axis_x = hn::Mul(x, one_by_length);
        cone.axis_y = hn::Mul(y, one_by_length);
        cone.axis_z = hn::Mul(z, one_by_length);
        cone.widening = hn::Mul(hn::Sub(at_apex, cone.radius), one_by_length);
        cone.widest = hn::Max(cone.radius, at_apex);
        cone.rounding = hn::Set(d, rounding_);
        return cone;
    }

    static std::size_t number(std::uint32_t primitive) {
        return std::size_t{2} * (primitive & ~WideBvh::kLast);
    }

    template <class M>
    static HWY_INLINE std::uint32_t bits(M mask) {
        std::uint8_t stored[8] = {};
        hn::StoreMaskBits(Four(), mask, stored);
        return stored[0];
    }

    glm::vec3 origin_, direction_;
    float t_min_;
    float steepest_;
    float rounding_ = 0.0f;
    bool idle_ = false;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
