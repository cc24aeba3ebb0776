// Vectors of doubles, and triples of these with more operations of glm and std, in the same order
// so that not a bit differs. Included once for each instruction set.
#if defined(RAYPICK_DOUBLE_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_DOUBLE_VECTORS_INL_H
#undef RAYPICK_DOUBLE_VECTORS_INL_H
#else
#define RAYPICK_DOUBLE_VECTORS_INL_H
#endif

#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/triples-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using LaneDoubles = std::array<double, kDoublesAtOnce>;

template <class M>
HWY_INLINE std::uint32_t double_bits(M mask) {
    return bits_of_mask(Doubles(), mask);
}

HWY_INLINE DoubleVector load_doubles(const LaneDoubles& numbers) {
    return hn::Load(Doubles(), numbers.data());
}

using DoubleVector3 = Triple<DoubleVector>;
HWY_INLINE DoubleVector3 load_doubles(const std::array<LaneDoubles, 3>& numbers) {
    return {load_doubles(numbers[0]), load_doubles(numbers[1]), load_doubles(numbers[2])};
}
HWY_INLINE DoubleVector3 over(const DoubleVector3& a, DoubleVector k) {
    return {hn::Div(a.x, k), hn::Div(a.y, k), hn::Div(a.z, k)};
}
HWY_INLINE DoubleVector length(const DoubleVector3& a) {
    return hn::Sqrt(dot(a, a));
}
HWY_INLINE DoubleVector3 normalize(const DoubleVector3& a) {
    return times(hn::Div(hn::Set(Doubles(), 1.0), length(a)), a);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
