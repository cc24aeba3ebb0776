// The corners of a patch's triangles, side by side. Included once for each instruction set.
#if defined(RAYPICK_PATCH_CORNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_PATCH_CORNERS_INL_H
#undef RAYPICK_PATCH_CORNERS_INL_H
#else
#define RAYPICK_PATCH_CORNERS_INL_H
#endif

#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/triangle_patches.h"

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// As many triangles of a patch as one instruction takes.
using Triangles = hn::CappedTag<float, 8>;
using TriangleFloats = hn::Vec<Triangles>;
inline constexpr std::size_t kTrianglesAtOnce = hn::MaxLanes(Triangles());

// Picks corner k of the triangles from `first` on out of the coordinates along an axis.
class CornerPick {
public:
#if HWY_TARGET <= HWY_AVX2
    // `first` is the one and only.
    HWY_INLINE CornerPick(const TrianglePatch& patch, std::size_t k, std::size_t /*first*/)
        : number_(hn::Shr(hn::Set(Numbers(), patch.corner[k]), hn::Load(Numbers(), kShifts))) {}
#else
    HWY_INLINE CornerPick(const TrianglePatch& patch, std::size_t k, std::size_t first)
        : numbers_(patch.corner[k] >> (4 * first)) {}
#endif

    HWY_INLINE TriangleFloats of(const float* coordinates) const {
        const Triangles d;
#if HWY_TARGET <= HWY_AVX3
        const auto low = hn::LoadU(d, coordinates);
        const auto high = hn::LoadU(d, coordinates + 8);
        return TriangleFloats{_mm256_permutex2var_ps(low.raw, number_.raw, high.raw)};
#elif HWY_TARGET <= HWY_AVX2
        const TriangleFloats low{
            _mm256_permutevar8x32_ps(hn::LoadU(d, coordinates).raw, number_.raw)};
        const TriangleFloats high{
            _mm256_permutevar8x32_ps(hn::LoadU(d, coordinates + 8).raw, number_.raw)};
        const auto sign = hn::BitCast(d, hn::ShiftLeft<28>(number_));
        return hn::IfNegativeThenElse(sign, high, low);
#else
        HWY_ALIGN float picked[kTrianglesAtOnce];
        for (std::size_t i = 0; i < kTrianglesAtOnce; ++i)
            picked[i] = coordinates[(numbers_ >> (4 * i)) & 15u];
        return hn::Load(d, picked);
#endif
    }

private:
#if HWY_TARGET <= HWY_AVX2
    using Numbers = hn::Rebind<std::uint32_t, Triangles>;
    HWY_ALIGN static constexpr std::uint32_t kShifts[8] = {0, 4, 8, 12, 16, 20, 24, 28};

    hn::Vec<Numbers> number_;  // beyond bit 3: whatever
#else
    std::uint32_t numbers_;
#endif
};

template <class M>
HWY_INLINE std::uint32_t triangle_bits(M mask) {
    return bits_of_mask(Triangles(), mask);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
