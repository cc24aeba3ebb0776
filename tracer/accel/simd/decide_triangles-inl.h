// intersect_triangle for several rays at once, each with a triangle of its own: the same operations
// on doubles in the same order, so that not a bit differs. Included once for each instruction set.
#if defined(RAYPICK_DECIDE_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_DECIDE_TRIANGLES_INL_H
#undef RAYPICK_DECIDE_TRIANGLES_INL_H
#else
#define RAYPICK_DECIDE_TRIANGLES_INL_H
#endif

#include "tracer/geometry/shapes.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using DoubleVector = hn::Vec<Doubles>;
inline constexpr std::size_t kDoublesAtOnce = hn::MaxLanes(Doubles());

// Rays with a triangle each, in the rays' sheared axes (see shear() in triangle_test.h).
struct TrianglePairs {
    using Numbers = std::array<double, kDoublesAtOnce>;
    HWY_ALIGN std::array<Numbers, 3> direction;              // along kx, ky, kz
    HWY_ALIGN std::array<std::array<Numbers, 3>, 3> offset;  // of each corner from the origin

    HWY_INLINE void set(std::size_t lane, const glm::dvec3& origin, const glm::dvec3& along,
                        const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const double x = std::abs(along.x);
        const double y = std::abs(along.y);
        const double z = std::abs(along.z);
        const int kz = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        int kx = kz == 2 ? 0 : kz + 1;
        int ky = kx == 2 ? 0 : kx + 1;
        if (along[kz] < 0.0) std::swap(kx, ky);
        const int axes[3] = {kx, ky, kz};
        for (std::size_t i = 0; i < 3; ++i) {
            const int k = axes[i];
            direction[i][lane] = along[k];
            offset[0][i][lane] = static_cast<double>(a[k]) - origin[k];
            offset[1][i][lane] = static_cast<double>(b[k]) - origin[k];
            offset[2][i][lane] = static_cast<double>(c[k]) - origin[k];
        }
    }

    // Numbers, whichever, from this lane on.
    HWY_INLINE void fill_from(std::size_t lane) {
        for (; lane < kDoublesAtOnce; ++lane)
            set(lane, glm::dvec3(0.0), glm::dvec3(1.0), glm::vec3(0.0f), glm::vec3(0.0f),
                glm::vec3(0.0f));
    }
};

// As intersect_triangle sees it.
inline bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a) != glm::dvec3(0.0);
}

struct TriangleAnswers {
    using Numbers = std::array<double, kDoublesAtOnce>;
    HWY_ALIGN Numbers t, u, v, determinant;
    std::uint32_t hit = 0;  // as a mask

    // At a t between the two.
    [[nodiscard]] bool hits(std::size_t lane, float t_min, float t_max) const {
        const auto at = static_cast<float>(t[lane]);
        return ((hit >> lane) & 1) != 0 && at > t_min && at < t_max;
    }
};

HWY_INLINE void swap_larger(DoubleVector& a, DoubleVector& b) {
    const auto larger = hn::Gt(hn::Abs(a), hn::Abs(b));
    const auto first = hn::IfThenElse(larger, b, a);
    b = hn::IfThenElse(larger, a, b);
    a = first;
}

HWY_INLINE DoubleVector ordered_sum(DoubleVector a, DoubleVector b, DoubleVector c) {
    swap_larger(a, b);
    swap_larger(b, c);
    swap_larger(a, b);
    return hn::Add(hn::Add(a, b), c);
}

// For triangles with an area only: those of none are not recognised here.
inline void decide(const TrianglePairs& pairs, TriangleAnswers& answers) {
    const Doubles d;
    const auto load = [&](const TrianglePairs::Numbers& numbers)
                          HWY_ATTR { return hn::Load(d, numbers.data()); };
    const auto along = load(pairs.direction[2]);
    const auto sx = hn::Div(load(pairs.direction[0]), along);
    const auto sy = hn::Div(load(pairs.direction[1]), along);
    const auto sz = hn::Div(hn::Set(d, 1.0), along);
    const auto az = load(pairs.offset[0][2]);
    const auto bz = load(pairs.offset[1][2]);
    const auto cz = load(pairs.offset[2][2]);
    const auto ax = hn::Sub(load(pairs.offset[0][0]), hn::Mul(sx, az));
    const auto ay = hn::Sub(load(pairs.offset[0][1]), hn::Mul(sy, az));
    const auto bx = hn::Sub(load(pairs.offset[1][0]), hn::Mul(sx, bz));
    const auto by = hn::Sub(load(pairs.offset[1][1]), hn::Mul(sy, bz));
    const auto cx = hn::Sub(load(pairs.offset[2][0]), hn::Mul(sx, cz));
    const auto cy = hn::Sub(load(pairs.offset[2][1]), hn::Mul(sy, cz));
    const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
    const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
    const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
    const auto zero = hn::Zero(d);
    const auto positive = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero));
    const auto negative = hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero));
    const auto determinant = ordered_sum(u, v, w);
    const auto hit = hn::And(hn::Or(positive, negative), hn::Gt(hn::Abs(determinant), zero));
    const auto scaled = ordered_sum(hn::Mul(u, hn::Mul(sz, az)), hn::Mul(v, hn::Mul(sz, bz)),
                                    hn::Mul(w, hn::Mul(sz, cz)));
    hn::Store(hn::Div(scaled, determinant), d, answers.t.data());
    hn::Store(hn::Div(v, determinant), d, answers.u.data());
    hn::Store(hn::Div(w, determinant), d, answers.v.data());
    hn::Store(determinant, d, answers.determinant.data());
    std::uint8_t stored[8] = {};
    hn::StoreMaskBits(d, hit, stored);
    answers.hit = stored[0];
}

// Decides the mask's rays, each with a triangle that set(ray, pairs, lane) puts into a lane; false:
// it has none. settle(ray, answers, lane) is told of those that have.
template <typename Set, typename Settle>
void decide_rays(std::uint64_t mask, const Set& set, const Settle& settle) {
    TrianglePairs pairs;
    TriangleAnswers answers;
    std::array<std::size_t, kDoublesAtOnce> rays{};
    while (mask != 0) {
        std::size_t count = 0;
        for (; mask != 0 && count < kDoublesAtOnce; mask &= mask - 1) {
            rays[count] = static_cast<std::size_t>(std::countr_zero(mask));
            if (set(rays[count], pairs, count)) ++count;
        }
        if (count == 0) return;
        pairs.fill_from(count);
        decide(pairs, answers);
        for (std::size_t lane = 0; lane < count; ++lane)
            settle(rays[lane], answers, lane);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
