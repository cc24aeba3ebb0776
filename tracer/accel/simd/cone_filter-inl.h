// Cones that a ray surely misses, several at a time: see cone_bounds-inl.h.
// Included once for each instruction set.
#if defined(RAYPICK_CONE_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_CONE_FILTER_INL_H
#undef RAYPICK_CONE_FILTER_INL_H
#else
#define RAYPICK_CONE_FILTER_INL_H
#endif

#include "tracer/accel/leaf_elements.h"
#include "tracer/accel/simd/cone_bounds-inl.h"
#include "tracer/accel/simd/mask_bits-inl.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

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

    // Of up to four cones, as a leaf has them, those that the ray may hit at a t of at most
    // `limit`, as a mask. `Elements` is SetElements or LeafElements.
    template <typename Elements>
    HWY_INLINE std::uint32_t may_hit(const Elements& cones, float limit) const {
        const std::uint32_t all = (1u << cones.size()) - 1u;
        if (idle_) return all;
        const ConeLanes<FourFloats> at = lanes(cones);
        const RayLanes<FourFloats> ray = ray_lanes(limit);
        ConeBounds<Four> bounds(at, ray);
        const std::uint32_t left = all & ~bits(bounds.passes_by());
        if (left == 0) return 0;
        bounds.estimate();
        return left & ~bits(bounds.misses());
    }

private:
    HWY_INLINE RayLanes<FourFloats> ray_lanes(float limit) const {
        const Four d;
        return {hn::Set(d, origin_.x),    hn::Set(d, origin_.y),    hn::Set(d, origin_.z),
                hn::Set(d, direction_.x), hn::Set(d, direction_.y), hn::Set(d, direction_.z),
                hn::Set(d, steepest_),    hn::Set(d, t_min_),       hn::Set(d, limit)};
    }

    template <typename Elements>
    HWY_INLINE ConeLanes<FourFloats> lanes(const Elements& cones) const {
        const std::size_t last = cones.size() - 1;
        const Four d;
        const glm::vec4* c0 = cones.row(0);
        const glm::vec4* c1 = cones.row(std::min(std::size_t{1}, last));
        const glm::vec4* c2 = cones.row(std::min(std::size_t{2}, last));
        const glm::vec4* c3 = cones.row(last);
        return cone_lanes(d, four(c0->x, c1->x, c2->x, c3->x), four(c0->y, c1->y, c2->y, c3->y),
                          four(c0->z, c1->z, c2->z, c3->z), four(c0->w, c1->w, c2->w, c3->w),
                          four(c0[1].x, c1[1].x, c2[1].x, c3[1].x),
                          four(c0[1].y, c1[1].y, c2[1].y, c3[1].y),
                          four(c0[1].z, c1[1].z, c2[1].z, c3[1].z),
                          four(c0[1].w, c1[1].w, c2[1].w, c3[1].w), hn::Set(d, rounding_));
    }

    template <class M>
    static HWY_INLINE std::uint32_t bits(M mask) {
        return bits_of_mask(Four(), mask);
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
