// What float bounds say of one ray with several primitives. Included once for each instruction set.
#if defined(RAYPICK_RAY_VERDICT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_VERDICT_INL_H
#undef RAYPICK_RAY_VERDICT_INL_H
#else
#define RAYPICK_RAY_VERDICT_INL_H
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// Of a patch's triangles, or of some of a leaf's elements; the numbers are those of the sure ones.
struct RayVerdict {
    static constexpr std::size_t kMost = 8;

    std::uint32_t may = 0;                        // hit, as a mask
    std::uint32_t sure = 0;                       // to hit, of those
    HWY_ALIGN std::array<float, kMost> from, to;  // t is between the two
};

template <typename Body>
HWY_INLINE void each_bit(std::uint32_t mask, const Body& body) {
    for (; mask != 0; mask &= mask - 1)
        body(static_cast<std::size_t>(std::countr_zero(mask)));
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
