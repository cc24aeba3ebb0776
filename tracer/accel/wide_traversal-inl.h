// One ray down a wide tree. Included once for each instruction set.
#if defined(RAYPICK_WIDE_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_WIDE_TRAVERSAL_INL_H
#undef RAYPICK_WIDE_TRAVERSAL_INL_H
#else
#define RAYPICK_WIDE_TRAVERSAL_INL_H
#endif

#include "tracer/bvh/wide_bvh.h"

#include <glm/vec3.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// `number`, or `instead` if that is no number.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V number_or_larger(D /*d*/, V number, V instead) {
#if HWY_ARCH_X86
    return hn::Max(number, instead);  // gives the second if either is a NaN
#else
    return hn::IfThenElse(hn::Gt(number, instead), number, instead);
#endif
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V number_or_smaller(D /*d*/, V number, V instead) {
#if HWY_ARCH_X86
    return hn::Min(number, instead);
#else
    return hn::IfThenElse(hn::Lt(number, instead), number, instead);
#endif
}

// Of coordinates: more than rounding in double moves what the scalar tests decide. Boxes are
// widened by it, so that whatever these would find is offered to them.
inline constexpr float kDoubleSlop = 0x1p-42f;

// The children that a ray may meet.
struct BoxHits {
    std::uint32_t mask = 0;
    HWY_ALIGN std::array<float, kWidth> enter;  // at the earliest; of those in the mask
};

// A ray as the slab tests see it. `slop` widens every box by an absolute amount, for rays that were
// rounded on their way into object space.
class SlabRay {
public:
    SlabRay(const glm::vec3& origin, const glm::vec3& direction, float slop) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<int>(axis);
            const float inverse = 1.0f / direction[i];
            const bool negative = std::signbit(inverse);
            first_[axis] = negative ? 3 + axis : axis;
            second_[axis] = negative ? axis : 3 + axis;
            inverse_near_[axis] = inverse * kShrink;
            inverse_far_[axis] = inverse * kGrow;
            near_origin_[axis] = origin[i] + (negative ? -slop : slop);
            far_origin_[axis] = origin[i] - (negative ? -slop : slop);
        }
    }

    // The children's boxes that the ray may meet within [t_min, t_max]. Conservative under rounding
    // (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013); 0 * infinity counts as inside the slab.
    HWY_INLINE void meet(const WideNode& node, float t_min, float t_max, BoxHits& hits) const {
        const hn::CappedTag<float, kWidth> d;
        std::uint32_t mask = 0;
        for (std::size_t i = 0; i < kWidth; i += hn::Lanes(d)) {
            auto near = hn::Set(d, t_min);
            auto far = hn::Set(d, t_max);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto first = hn::Load(d, node.planes[first_[axis]].data() + i);
                const auto second = hn::Load(d, node.planes[second_[axis]].data() + i);
                near = number_or_larger(d,
                                        hn::Mul(hn::Sub(first, hn::Set(d, near_origin_[axis])),
                                                hn::Set(d, inverse_near_[axis])),
                                        near);
                far = number_or_smaller(d,
                                        hn::Mul(hn::Sub(second, hn::Set(d, far_origin_[axis])),
                                                hn::Set(d, inverse_far_[axis])),
                                        far);
            }
            hn::Store(near, d, hits.enter.data() + i);
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Le(near, far), bits);
            mask |= static_cast<std::uint32_t>(bits[0]) << i;
        }
        hits.mask = mask;
    }

private:
    static constexpr float kGrow = 1.0f + 8.0f * 5.9604645e-8f;
    static constexpr float kShrink = 1.0f - 8.0f * 5.9604645e-8f;

    std::array<float, 3> inverse_near_{};
    std::array<float, 3> inverse_far_{};
    std::array<float, 3> near_origin_{};
    std::array<float, 3> far_origin_{};
    std::array<std::size_t, 3> first_{};  // the plane that it meets first
    std::array<std::size_t, 3> second_{};
};

// Calls leaf(ref) for the leaves that the ray may meet before limit(), near ones first; limit() may
// shrink on the way. Stops and returns true as soon as leaf() does.
template <typename Limit, typename Leaf>
bool walk(const WideBvh& bvh, const WideRef& start, const SlabRay& ray, float t_min,
          const Limit& limit, const Leaf& leaf) {
    struct Waiting {
        std::uint32_t first;
        std::uint32_t count;
        float enter;
    };
    Waiting stack[WideBvh::kMostWaiting];  // NOLINT: not initialised, for it is large
    std::size_t waiting = 0;
    BoxHits hits;
    WideRef at = start;
    for (;;) {
        if (at.count > 0) {
            if (leaf(at)) return true;
        } else {
            const WideNode& node = bvh.nodes[at.first];
            ray.meet(node, t_min, limit(), hits);
            const std::size_t nearer = waiting;
            for (std::uint32_t mask = hits.mask; mask != 0; mask &= mask - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(mask));
                const float enter = hits.enter[i];
                std::size_t place = waiting++;
                for (; place > nearer && stack[place - 1].enter < enter; --place)
                    stack[place] = stack[place - 1];
                stack[place] = {node.child[i], node.count[i], enter};
            }
        }
        do {
            if (waiting == 0) return false;
            --waiting;
        } while (!(stack[waiting].enter <= limit()));
        at = {stack[waiting].first, stack[waiting].count};
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
