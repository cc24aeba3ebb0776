// Triangles that a ray surely misses, several at a time, in float; the others are for
// intersect_triangle to decide. Included once for each instruction set.
#if defined(RAYPICK_TRIANGLE_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_TRIANGLE_FILTER_INL_H
#undef RAYPICK_TRIANGLE_FILTER_INL_H
#else
#define RAYPICK_TRIANGLE_FILTER_INL_H
#endif

#include "tracer/geometry/shapes.h"
#include "tracer/geometry/triangle_test.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

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

// The float twin of the watertight test (see triangle_test.h) with a bound on its rounding errors.
//
// With offsets from the origin and coordinates of at most `reach`, 2 reach bounds every offset v
// and each sheared coordinate is wrong by at most 6 u 2 reach (u = 2^-24: the subtraction, the
// origin's and the shear's own rounding, the product). An edge function cx by - cy bx of sheared
// coordinates of at most l is then wrong by less than 4 l 12 u reach + 4 u l^2 <= 80 u reach l.
class TriangleFilter {
public:
    TriangleFilter(const ShearedRay& ray, float reach)
        : kx_(ray.kx),
          ky_(ray.ky),
          kz_(ray.kz),
          ox_(static_cast<float>(ray.origin[ray.kx])),
          oy_(static_cast<float>(ray.origin[ray.ky])),
          oz_(static_cast<float>(ray.origin[ray.kz])),
          sx_(static_cast<float>(ray.sx)),
          sy_(static_cast<float>(ray.sy)),
          sz_(static_cast<float>(ray.sz)),
          reach_(reach),
          // Beyond it products overflow: then nothing is ruled out.
          edge_error_(reach < 1e12f ? 96.0f * 0x1p-24f * reach
                                    : std::numeric_limits<float>::infinity()) {}

    // Of up to four triangles those that the ray may hit at a t of at most `limit`, as a mask.
    HWY_INLINE std::uint32_t may_hit(const Mesh& mesh, const std::uint32_t* primitives,
                                     std::uint32_t count, float limit) const {
        const Four d;
        const glm::uvec3* triangles = mesh.triangles.data();
        const std::uint32_t last = count - 1;
        const glm::uvec3 t0 = triangles[primitives[0]];
        const glm::uvec3 t1 = triangles[primitives[std::min(1u, last)]];
        const glm::uvec3 t2 = triangles[primitives[std::min(2u, last)]];
        const glm::uvec3 t3 = triangles[primitives[last]];
        const float* p = &mesh.positions.data()->x;
        const Corner a = sheared(p + 3 * std::size_t{t0.x}, p + 3 * std::size_t{t1.x},
                                 p + 3 * std::size_t{t2.x}, p + 3 * std::size_t{t3.x});
        const Corner b = sheared(p + 3 * std::size_t{t0.y}, p + 3 * std::size_t{t1.y},
                                 p + 3 * std::size_t{t2.y}, p + 3 * std::size_t{t3.y});
        const Corner c = sheared(p + 3 * std::size_t{t0.z}, p + 3 * std::size_t{t1.z},
                                 p + 3 * std::size_t{t2.z}, p + 3 * std::size_t{t3.z});
        const auto u = hn::NegMulAdd(c.y, b.x, hn::Mul(c.x, b.y));
        const auto v = hn::NegMulAdd(a.y, c.x, hn::Mul(a.x, c.y));
        const auto w = hn::NegMulAdd(b.y, a.x, hn::Mul(b.x, a.y));
        const auto largest = hn::Max(hn::Max(a.size, b.size), c.size);
        const auto error = hn::MulAdd(largest, hn::Set(d, edge_error_),
                                      hn::Set(d, 4.0f * std::numeric_limits<float>::min()));
        const auto least = hn::Min(hn::Min(u, v), w);
        const auto most = hn::Max(hn::Max(u, v), w);
        // Arranged so that a NaN rules nothing out.
        auto outside = hn::And(hn::Lt(least, hn::Neg(error)), hn::Gt(most, error));
        std::uint32_t left = ~bits(outside) & ((1u << count) - 1u);
        if (left == 0) return 0;
        // t = sz (u az + v bz + w cz) / (u + v + w); each of the three is wrong by `error`.
        const auto determinant = hn::Abs(hn::Add(hn::Add(u, v), w));
        const auto sum = hn::MulAdd(u, a.z, hn::MulAdd(v, b.z, hn::Mul(w, c.z)));
        const auto scaled = hn::Abs(hn::Mul(sum, hn::Set(d, sz_)));
        const auto sum_error = hn::Mul(error, hn::Set(d, 16.0f * reach_ * std::abs(sz_)));
        const auto farthest = hn::Mul(hn::MulAdd(error, hn::Set(d, 4.0f), determinant),
                                      hn::Set(d, limit * (1.0f + 0x1p-18f)));
        const auto beyond = hn::Gt(hn::Sub(scaled, sum_error), farthest);
        return left & ~bits(beyond);
    }

private:
    struct Corner {
        FourFloats x, y, z, size;
    };

    HWY_INLINE Corner sheared(const float* p0, const float* p1, const float* p2,
                              const float* p3) const {
        const Four d;
        const auto z = hn::Sub(four(p0[kz_], p1[kz_], p2[kz_], p3[kz_]), hn::Set(d, oz_));
        const auto x_offset = hn::Sub(four(p0[kx_], p1[kx_], p2[kx_], p3[kx_]), hn::Set(d, ox_));
        const auto y_offset = hn::Sub(four(p0[ky_], p1[ky_], p2[ky_], p3[ky_]), hn::Set(d, oy_));
        const auto x = hn::NegMulAdd(hn::Set(d, sx_), z, x_offset);
        const auto y = hn::NegMulAdd(hn::Set(d, sy_), z, y_offset);
        return {x, y, z, hn::Max(hn::Abs(x), hn::Abs(y))};
    }

    template <class M>
    static HWY_INLINE std::uint32_t bits(M mask) {
        std::uint8_t stored[8] = {};
        hn::StoreMaskBits(Four(), mask, stored);
        return stored[0];
    }

    int kx_, ky_, kz_;
    float ox_, oy_, oz_;
    float sx_, sy_, sz_;
    float reach_;
    float edge_error_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
