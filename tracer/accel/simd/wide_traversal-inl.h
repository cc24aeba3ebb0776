// One ray down a wide tree. Included once for each instruction set.
#if defined(RAYPICK_WIDE_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_WIDE_TRAVERSAL_INL_H
#undef RAYPICK_WIDE_TRAVERSAL_INL_H
#else
#define RAYPICK_WIDE_TRAVERSAL_INL_H
#endif

#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/packing-inl.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/geometry/ray.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
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

// As many boxes of a node as one instruction takes.
using Boxes = hn::CappedTag<float, kWidth>;
inline constexpr std::size_t kBoxesAtOnce = hn::MaxLanes(Boxes());

template <class M>
HWY_INLINE std::uint32_t box_bits(M mask) {
    return bits_of_mask(Boxes(), mask);
}

#if HWY_TARGET <= HWY_AVX2
// A node's children from far to near, for an octant of directions.
class FarToNear {
public:
    using Numbers = hn::Rebind<std::uint32_t, Boxes>;

    HWY_INLINE FarToNear(const WideNode& node, std::size_t octant)
        : order_(hn::Shr(hn::Set(Numbers(), node.far_to_near(octant)),
                         hn::Load(Numbers(), kShifts))) {}

    HWY_INLINE hn::Vec<Boxes> of(hn::Vec<Boxes> v) const {
        return hn::Vec<Boxes>{_mm256_permutevar8x32_ps(v.raw, order_.raw)};
    }
    HWY_INLINE hn::Vec<Numbers> of(hn::Vec<Numbers> v) const {
        return hn::Vec<Numbers>{_mm256_permutevar8x32_epi32(v.raw, order_.raw)};
    }
    HWY_INLINE hn::Vec<Numbers> numbers() const { return hn::And(order_, hn::Set(Numbers(), 7u)); }

private:
    HWY_ALIGN static constexpr std::uint32_t kShifts[8] = {0, 3, 6, 9, 12, 15, 18, 21};

    hn::Vec<Numbers> order_;  // beyond bit 2: whatever
};
#endif

// Where a ray may go on, and where it enters there at the earliest. Not initialised, as it is
// large. What waits in the top tree and in an object's may lie on one stack.
struct WaitingBoxes {
    std::size_t count;
    float enter[2 * WideBvh::kMostWaiting];
    std::uint32_t ref[2 * WideBvh::kMostWaiting];

    void push(float at, std::uint32_t what) {
        enter[count] = at;
        ref[count++] = what;
    }

    // Leaves out what is entered beyond `far`, of all that waits above `base`.
    HWY_INLINE void drop_beyond(float far, std::size_t base) {
        std::size_t kept = base;
#if HWY_TARGET <= HWY_AVX2
        const Boxes d;
        const hn::Rebind<std::uint32_t, Boxes> du;
        for (std::size_t i = base; i < count; i += kWidth) {
            const auto at = hn::LoadU(d, enter + i);
            const auto what = hn::LoadU(du, ref + i);
            const auto there = hn::FirstN(d, count - i);
            const Packing<Boxes> near(hn::And(there, hn::Le(at, hn::Set(d, far))));
            hn::StoreU(near.of(at), d, enter + kept);
            hn::StoreU(near.of(what), du, ref + kept);
            kept += near.count();
        }
#else
        for (std::size_t i = base; i < count; ++i) {
            enter[kept] = enter[i];
            ref[kept] = ref[i];
            kept += enter[i] <= far ? 1u : 0u;
        }
#endif
        count = kept;
    }
};

// A ray as the slab tests see it. `slop` widens every box by an absolute amount, for rays that were
// rounded on their way into object space.
class SlabRay {
public:
    SlabRay(const glm::vec3& origin, const glm::vec3& direction, float slop)
        : SlabRay(Ray{origin, direction}, slop) {}

    SlabRay(const Ray& ray, float slop) {
        static_assert(sizeof(Ray) == 8 * sizeof(float) && offsetof(Ray, direction) == 12);
        const Axes d;
        const hn::Rebind<std::uint32_t, Axes> du;
        const auto* numbers = reinterpret_cast<const float*>(&ray);
        for (std::size_t i = 0; i < kAxes; i += hn::Lanes(d)) {
            const auto origin = hn::LoadU(d, numbers + i);
            const auto inverse = hn::Div(hn::Set(d, 1.0f), hn::LoadU(d, numbers + 3 + i));
            const auto negative = hn::ShiftRight<31>(hn::BitCast(du, inverse));
            const auto widen = hn::CopySign(hn::Set(d, slop), inverse);
            const auto low = hn::Load(du, kLow + i);
            const auto either = hn::Mul(negative, hn::Set(du, 3 * kWidth));
            hn::Store(hn::Add(low, either), du, first_ + i);
            hn::Store(hn::Sub(hn::Add(low, hn::Set(du, 3 * kWidth)), either), du, second_ + i);
            hn::Store(hn::Mul(inverse, hn::Set(d, kShrink)), d, inverse_near_ + i);
            hn::Store(hn::Mul(inverse, hn::Set(d, kGrow)), d, inverse_far_ + i);
            hn::Store(hn::Add(origin, widen), d, near_origin_ + i);
            hn::Store(hn::Sub(origin, widen), d, far_origin_ + i);
            const auto is_negative = hn::Ne(negative, hn::Zero(du));
            octant_ |= std::size_t{bits_of_mask(du, is_negative)} << i;
        }
        octant_ &= 7;
    }

    // Puts the children whose boxes the ray may meet within [t_min, t_max] onto the stack, near
    // ones last. Conservative under rounding (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013); 0
    // * infinity counts as inside the slab.
    HWY_INLINE void push_met(const WideNode& node, float t_min, float t_max,
                             WaitingBoxes& stack) const {
#if HWY_TARGET <= HWY_AVX2
        push_ordered(node, meet(node, 0, t_min, t_max), stack);
#else
        HWY_ALIGN float enter[kWidth];
        std::uint32_t mask = 0;
        for (std::size_t i = 0; i < kWidth; i += kBoxesAtOnce) {
            const Interval met = meet(node, i, t_min, t_max);
            hn::Store(met.near, Boxes(), enter + i);
            mask |= box_bits(hn::Le(met.near, met.far)) << i;
        }
        for (std::uint32_t order = node.far_to_near(octant_), i = 0; i < kWidth; ++i, order >>= 3) {
            if (((mask >> (order & 7u)) & 1u) != 0) {
                stack.push(enter[order & 7u], node.child[order & 7u]);
            }
        }
#endif
    }

private:
    using BoxFloats = hn::Vec<Boxes>;
    struct Interval {
        BoxFloats near, far;
    };

    HWY_INLINE Interval meet(const WideNode& node, std::size_t i, float t_min, float t_max) const {
        const Boxes d;
        const float* planes = node.planes[0].data() + i;
        auto near = hn::Set(d, t_min);
        auto far = hn::Set(d, t_max);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto first = hn::Load(d, planes + first_[axis]);
            const auto second = hn::Load(d, planes + second_[axis]);
            near = number_or_larger(d,
                                    hn::Mul(hn::Sub(first, hn::Set(d, near_origin_[axis])),
                                            hn::Set(d, inverse_near_[axis])),
                                    near);
            far = number_or_smaller(d,
                                    hn::Mul(hn::Sub(second, hn::Set(d, far_origin_[axis])),
                                            hn::Set(d, inverse_far_[axis])),
                                    far);
        }
        return {near, far};
    }

#if HWY_TARGET <= HWY_AVX2
    HWY_INLINE void push_ordered(const WideNode& node, const Interval& met,
                                 WaitingBoxes& stack) const {
        const Boxes d;
        const hn::Rebind<std::uint32_t, Boxes> du;
        const FarToNear order(node, octant_);
        const auto near = order.of(met.near);
        const auto child = order.of(hn::Load(du, node.child.data()));
        const Packing<Boxes> met_ones(hn::Le(near, order.of(met.far)));
        hn::StoreU(met_ones.of(near), d, stack.enter + stack.count);
        hn::StoreU(met_ones.of(child), du, stack.ref + stack.count);
        stack.count += met_ones.count();
    }
#endif

    static constexpr float kGrow = 1.0f + 8.0f * 5.9604645e-8f;
    static constexpr float kShrink = 1.0f - 8.0f * 5.9604645e-8f;

    // By axis; the fourth is nobody's.
    static constexpr std::size_t kAxes = 4;
    using Axes = hn::CappedTag<float, kAxes>;
    alignas(16) static constexpr std::uint32_t kLow[kAxes] = {0, kWidth, 2 * kWidth, 3 * kWidth};

    alignas(16) float inverse_near_[kAxes];
    alignas(16) float inverse_far_[kAxes];
    alignas(16) float near_origin_[kAxes];
    alignas(16) float far_origin_[kAxes];
    alignas(16) std::uint32_t first_[kAxes];  // the plane that it meets first: where a node has it
    alignas(16) std::uint32_t second_[kAxes];
    std::size_t octant_ = 0;
};

// Calls leaf(ref) for the leaves that the ray may meet before limit(), near ones first; limit() may
// shrink on the way. Stops and returns true as soon as leaf() does.
template <typename Limit, typename Leaf>
bool walk(const WideBvh& bvh, const WideRef& start, const SlabRay& ray, float t_min,
          const Limit& limit, const Leaf& leaf) {
    WaitingBoxes stack;  // NOLINT: see there
    stack.count = 0;
    WideRef at = start;
    for (;;) {
        if (at.is_leaf()) {
            if (leaf(at)) return true;
        } else {
            ray.push_met(bvh.nodes[at.index()], t_min, limit(), stack);
        }
        do {
            if (stack.count == 0) return false;
            --stack.count;
        } while (!(stack.enter[stack.count] <= limit()));
        at = {stack.ref[stack.count]};
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
