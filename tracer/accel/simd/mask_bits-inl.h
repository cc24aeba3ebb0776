// Masks of lanes as numbers, bit i for lane i. Included once for each instruction set.
#if defined(RAYPICK_MASK_BITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_MASK_BITS_INL_H
#undef RAYPICK_MASK_BITS_INL_H
#else
#define RAYPICK_MASK_BITS_INL_H
#endif

#include <bit>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Of up to 16 lanes.
template <class D, class M>
HWY_INLINE std::uint32_t bits_of_mask(D d, M mask) {
    static_assert(hn::MaxLanes(D()) <= 16);
    std::uint8_t stored[8] = {};
    hn::StoreMaskBits(d, mask, stored);
    if constexpr (hn::MaxLanes(D()) <= 8) return stored[0];
    if constexpr (std::endian::native == std::endian::little) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, stored, sizeof(bits));
        return bits;
    }
    return stored[0] | static_cast<std::uint32_t>(stored[1]) << 8;
}
template <class D>
HWY_INLINE hn::Mask<D> mask_of_bits(D d, std::uint32_t bits) {
    static_assert(hn::MaxLanes(D()) <= 16);
    const std::uint8_t stored[8] = {static_cast<std::uint8_t>(bits),
                                    static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(d, stored);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
