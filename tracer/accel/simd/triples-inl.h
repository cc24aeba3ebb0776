// Triples of vectors with the operations of glm, in the same order so that not a bit differs.
// Included once for each instruction set.
#if defined(RAYPICK_TRIPLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_TRIPLES_INL_H
#undef RAYPICK_TRIPLES_INL_H
#else
#define RAYPICK_TRIPLES_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Triple {
    V x, y, z;
};
template <class V>
HWY_INLINE Triple<V> plus(const Triple<V>& a, const Triple<V>& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Triple<V> minus(const Triple<V>& a, const Triple<V>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Triple<V> times(V k, const Triple<V>& a) {
    return {hn::Mul(k, a.x), hn::Mul(k, a.y), hn::Mul(k, a.z)};
}
template <class V>
HWY_INLINE Triple<V> times(const Triple<V>& a, const Triple<V>& b) {
    return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
template <class V>
HWY_INLINE V dot(const Triple<V>& a, const Triple<V>& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
template <class V>
HWY_INLINE Triple<V> size(const Triple<V>& a) {
    return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
