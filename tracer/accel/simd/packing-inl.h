// Chosen lanes of a vector side by side at its beginning. Included once for each instruction set.
#if defined(RAYPICK_PACKING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_PACKING_INL_H
#undef RAYPICK_PACKING_INL_H
#else
#define RAYPICK_PACKING_INL_H
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_AVX2

// By a mask of eight lanes: the numbers of its lanes from the lowest on, four bits each.
inline constexpr std::array<std::uint32_t, 256> kPackedLanes = [] {
    std::array<std::uint32_t, 256> packed{};
    for (std::uint32_t mask = 0; mask < 256; ++mask) {
        std::uint32_t place = 0;
        for (std::uint32_t lane = 0; lane < 8; ++lane) {
            if ((mask >> lane & 1u) == 0) continue;
            packed[mask] |= lane << (4 * place);
            ++place;
        }
    }
    return packed;
}();

// As hn::Compress, whose table is copied onto the stack at every call (Highway 1.0.3).
template <class D>
class Packing {
public:
    HWY_INLINE explicit Packing(hn::Mask<D> mask)
        : mask_(static_cast<std::uint32_t>(
              _mm256_movemask_ps(hn::BitCast(Floats(), hn::VecFromMask(D(), mask)).raw))) {
        HWY_ALIGN static constexpr std::uint32_t kShifts[8] = {0, 4, 8, 12, 16, 20, 24, 28};
        lanes_ = hn::Shr(hn::Set(Numbers(), kPackedLanes[mask_]), hn::Load(Numbers(), kShifts));
    }

    // What lies beyond the chosen lanes is whatever.
    template <class V>
    [[nodiscard]] HWY_INLINE V of(V v) const {
        const hn::DFromV<V> d;
        return hn::BitCast(d, hn::Vec<Numbers>{_mm256_permutevar8x32_epi32(
                                  hn::BitCast(Numbers(), v).raw, lanes_.raw)});
    }
    [[nodiscard]] HWY_INLINE std::size_t count() const {
        return static_cast<std::size_t>(std::popcount(mask_));
    }

private:
    using Numbers = hn::RebindToUnsigned<D>;
    using Floats = hn::RebindToFloat<D>;
    static_assert(hn::MaxLanes(D()) == 8 && sizeof(hn::TFromD<D>) == 4);

    std::uint32_t mask_;
    hn::Vec<Numbers> lanes_;
};

#else

template <class D>
class Packing {
public:
    HWY_INLINE explicit Packing(hn::Mask<D> mask) : mask_(mask) {}

    template <class V>
    [[nodiscard]] HWY_INLINE V of(V v) const {
        return hn::Compress(v, hn::RebindMask(hn::DFromV<V>(), mask_));
    }
    [[nodiscard]] HWY_INLINE std::size_t count() const { return hn::CountTrue(D(), mask_); }

private:
    hn::Mask<D> mask_;
};

#endif

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
