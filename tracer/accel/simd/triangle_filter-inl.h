// Triangles of a patch that a ray surely misses, several at a time, in float; the others are for
// intersect_triangle to decide. Included once for each instruction set.
#if defined(RAYPICK_TRIANGLE_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_TRIANGLE_FILTER_INL_H
#undef RAYPICK_TRIANGLE_FILTER_INL_H
#else
#define RAYPICK_TRIANGLE_FILTER_INL_H
#endif

#include "tracer/accel/simd/patch_corners-inl.h"
#include "tracer/geometry/absolute.h"
#include "tracer/geometry/shapes.h"
#include "tracer/geometry/triangle_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The float twin of the watertight test (see triangle_test.h) with a bound on its rounding errors.
//
// With coordinates of at most `reach`, 2 reach bounds every offset v from the origin. The origin's
// rounding and the subtraction's (u = 2^-24) make it wrong by 3 u reach, and the shear's factor is
// wrong by 1 u, or 2 if it was worked out in double: a sheared coordinate of at most 4 reach is
// wrong by less than 18 u reach, and an edge function cx by - cy bx of coordinates of at most l by
// less than 4 l 18 u reach + 4 u l^2 <= 88 u reach l.
class TriangleFilter {
public:
    // Of a ray as it came.
    TriangleFilter(const glm::vec3& origin, const glm::vec3& direction)
        : kx_(kNext[longest_axis(direction)]),
          ky_(kNext[kx_]),
          kz_(kNext[ky_]),
          ox_(origin[kx_]),
          oy_(origin[ky_]),
          oz_(origin[kz_]),
          sx_(direction[kx_] / direction[kz_]),
          sy_(direction[ky_] / direction[kz_]),
          sz_(1.0f / direction[kz_]) {}

    // Of a ray that was transformed: its direction may be one that float can't hold.
    explicit TriangleFilter(const ShearedRay& ray)
        : kx_(ray.kx),
          ky_(ray.ky),
          kz_(ray.kz),
          ox_(static_cast<float>(ray.origin[kx_])),
          oy_(static_cast<float>(ray.origin[ky_])),
          oz_(static_cast<float>(ray.origin[kz_])),
          sx_(static_cast<float>(ray.direction[kx_] / ray.direction[kz_])),
          sy_(static_cast<float>(ray.direction[ky_] / ray.direction[kz_])),
          sz_(static_cast<float>(1.0 / ray.direction[kz_])) {}

    // Those of the patch that the ray may hit at a t of at most `limit`, as a mask. `reach` is the
    // largest coordinate of the origin and of the mesh.
    HWY_INLINE std::uint32_t may_hit(const TrianglePatch& patch, float reach, float limit) const {
        std::uint32_t mask = 0;
        for (std::size_t i = 0; i < TrianglePatch::kMostTriangles; i += kTrianglesAtOnce) {
            if (i >= patch.triangles) break;
            mask |= some_may_hit(patch, i, reach, limit) << i;
        }
        return mask & ((1u << patch.triangles) - 1u);
    }

private:
    struct Corner {
        TriangleFloats x, y, z, size;
    };

    HWY_INLINE std::uint32_t some_may_hit(const TrianglePatch& patch, std::size_t first,
                                          float reach, float limit) const {
        const Triangles d;
        const Corner a = sheared(patch, 0, first);
        const Corner b = sheared(patch, 1, first);
        const Corner c = sheared(patch, 2, first);
        const auto u = hn::NegMulAdd(c.y, b.x, hn::Mul(c.x, b.y));
        const auto v = hn::NegMulAdd(a.y, c.x, hn::Mul(a.x, c.y));
        const auto w = hn::NegMulAdd(b.y, a.x, hn::Mul(b.x, a.y));
        const auto largest = hn::Max(hn::Max(a.size, b.size), c.size);
        // Beyond 1e12 products overflow: then nothing is ruled out.
        const float edge_error =
            reach < 1e12f ? 0x1p-24f * 128.0f * reach : std::numeric_limits<float>::infinity();
        const auto error = hn::MulAdd(largest, hn::Set(d, edge_error),
                                      hn::Set(d, 4.0f * std::numeric_limits<float>::min()));
        const auto least = hn::Min(hn::Min(u, v), w);
        const auto most = hn::Max(hn::Max(u, v), w);
        // Arranged so that a NaN rules nothing out.
        const auto outside = hn::And(hn::Lt(least, hn::Neg(error)), hn::Gt(most, error));
        // t = sz (u az + v bz + w cz) / (u + v + w); each of the three is wrong by `error`.
        const auto determinant = hn::Abs(hn::Add(hn::Add(u, v), w));
        const auto sum = hn::MulAdd(u, a.z, hn::MulAdd(v, b.z, hn::Mul(w, c.z)));
        const auto scaled = hn::Abs(hn::Mul(sum, hn::Set(d, sz_)));
        const auto sum_error = hn::Mul(error, hn::Set(d, 16.0f * reach * std::abs(sz_)));
        const auto farthest = hn::Mul(hn::MulAdd(error, hn::Set(d, 4.0f), determinant),
                                      hn::Set(d, limit * (1.0f + 0x1p-18f)));
        const auto beyond = hn::Gt(hn::Sub(scaled, sum_error), farthest);
        return ~triangle_bits(hn::Or(outside, beyond)) & ((1u << kTrianglesAtOnce) - 1u);
    }

    HWY_INLINE Corner sheared(const TrianglePatch& patch, std::size_t k, std::size_t first) const {
        const Triangles d;
        const CornerPick pick(patch, k, first);
        const auto z = hn::Sub(pick.of(patch.along(kz_)), hn::Set(d, oz_));
        const auto x_offset = hn::Sub(pick.of(patch.along(kx_)), hn::Set(d, ox_));
        const auto y_offset = hn::Sub(pick.of(patch.along(ky_)), hn::Set(d, oy_));
        const auto x = hn::NegMulAdd(hn::Set(d, sx_), z, x_offset);
        const auto y = hn::NegMulAdd(hn::Set(d, sy_), z, y_offset);
        return {x, y, z, hn::Max(hn::Abs(x), hn::Abs(y))};
    }

    // Without a branch, as it can't be foretold.
    static int longest_axis(const glm::vec3& direction) {
        const glm::vec3 d = absolute(direction);
        const int z_is_longest = static_cast<int>(d.z >= std::max(d.x, d.y));
        const int y_is_longest = static_cast<int>(d.y >= d.x) & (1 - z_is_longest);
        return y_is_longest + 2 * z_is_longest;
    }

    static constexpr int kNext[3] = {1, 2, 0};

    int kx_, ky_, kz_;
    float ox_, oy_, oz_;
    float sx_, sy_, sz_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
