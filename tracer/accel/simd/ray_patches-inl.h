// Single rays of a group against all triangles of a patch at once. Included once for each
// instruction set.
#if defined(RAYPICK_RAY_PATCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_PATCHES_INL_H
#undef RAYPICK_RAY_PATCHES_INL_H
#else
#define RAYPICK_RAY_PATCHES_INL_H
#endif

#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/triangle_bounds-inl.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Where a vector of rays has many gaps and a patch has few, this takes fewer lanes. The other way
// is quicker for as many, and vectors of sixteen rays take no longer than two of eight triangles.
inline bool better_ray_by_ray(const TrianglePatch& patch, RayMask mask) {
    std::size_t vectors = 0;
    each_vector(mask, [&](std::size_t, RayMask) HWY_ATTR { ++vectors; });
    const std::size_t triangles = patch.triangles;
    const std::size_t padded =
        (triangles + kTrianglesAtOnce - 1) / kTrianglesAtOnce * kTrianglesAtOnce;
    const auto rays = static_cast<std::size_t>(std::popcount(mask));
    constexpr std::size_t kHalves = kAtOnce > 8 ? 4 : 3;
    return kHalves * rays * padded < 2 * triangles * vectors * kAtOnce;
}

template <typename Body>
HWY_INLINE void each_bit(std::uint32_t mask, const Body& body) {
    for (; mask != 0; mask &= mask - 1)
        body(static_cast<std::size_t>(std::countr_zero(mask)));
}

// What the bounds say of a ray with a patch's triangles; the numbers are those of the sure ones.
struct PatchVerdict {
    std::uint32_t may = 0;
    std::uint32_t sure = 0;
    HWY_ALIGN std::array<float, TrianglePatch::kMostTriangles> from, to;
};

HWY_INLINE TriangleFloats dots(const GroupTriangles::Vectors& v, std::size_t first,
                               const TriangleFloats& x, const TriangleFloats& y,
                               const TriangleFloats& z) {
    const Triangles d;
    const auto load = [&](std::size_t axis)
                          HWY_ATTR { return hn::Load(d, v[axis].data() + first); };
    return hn::MulAdd(load(0), x, hn::MulAdd(load(1), y, hn::Mul(load(2), z)));
}

// As of several origins, see there.
HWY_INLINE EdgeFunctions<TriangleFloats> edge_functions_of_ray(const GroupRays& rays,
                                                               std::size_t ray,
                                                               const GroupTriangles& all,
                                                               std::size_t first) {
    const Triangles d;
    const auto dx = hn::Set(d, rays.direction[0][ray]);
    const auto dy = hn::Set(d, rays.direction[1][ray]);
    const auto dz = hn::Set(d, rays.direction[2][ray]);
    const auto from_origin = [&](std::size_t axis) HWY_ATTR {
        return hn::Sub(hn::Load(d, all.a[axis].data() + first), hn::Set(d, rays.origin[axis][ray]));
    };
    const auto x = from_origin(0);
    const auto y = from_origin(1);
    const auto z = from_origin(2);
    const auto rx = hn::NegMulAdd(dz, y, hn::Mul(dy, z));
    const auto ry = hn::NegMulAdd(dx, z, hn::Mul(dz, x));
    const auto rz = hn::NegMulAdd(dy, x, hn::Mul(dx, y));
    EdgeFunctions<TriangleFloats> f;
    f.slope = dots(all.n, first, dx, dy, dz);
    f.v = hn::Neg(dots(all.edge_c, first, rx, ry, rz));
    f.w = dots(all.edge_b, first, rx, ry, rz);
    f.u = hn::Sub(f.slope, hn::Add(f.v, f.w));
    f.height = dots(all.n, first, x, y, z);
    return f;
}

// The triangles from `first` on, as many as one instruction takes.
HWY_INLINE void judge_some_of_patch(const GroupRays& rays, const GroupLimits& limits,
                                    std::size_t ray, const GroupTriangles& all, std::size_t first,
                                    const ShownSides& shown, PatchVerdict& verdict) {
    const Triangles d;
    const EdgeFunctions<TriangleFloats> f = edge_functions_of_ray(rays, ray, all, first);
    const EdgeBounded<Triangles> edges(f, hn::Load(d, all.edge_error.data() + first));
    std::uint32_t may = ~triangle_bits(edges.misses(shown)) & ((1u << kTrianglesAtOnce) - 1u);
    if (may == 0) return;
    const PlaneBounded<Triangles> plane(
        f.slope, hn::Load(d, all.slope_error.data() + first),
        Height<TriangleFloats>{f.height, hn::Load(d, all.height_error.data() + first)});
    const auto t_min = hn::Set(d, limits.t_min[ray]);
    const auto t_far = hn::Set(d, limits.t_far[ray]);
    may &= ~triangle_bits(plane.misses(t_min, t_far));
    if (may == 0) return;
    const auto from = plane.from();
    const auto to = plane.to();
    const auto sure = hn::And(edges.surely_within(), plane.surely_within(from, to, t_min, t_far));
    hn::Store(from, d, verdict.from.data() + first);
    hn::Store(to, d, verdict.to.data() + first);
    verdict.may |= may << first;
    verdict.sure |= (may & triangle_bits(sure)) << first;
}

// Of rays that are followed forwards.
HWY_INLINE void judge_patch_of_ray(const GroupRays& rays, const GroupLimits& limits,
                                   std::size_t ray, const GroupTriangles& all,
                                   std::size_t triangles, const ShownSides& shown,
                                   PatchVerdict& verdict) {
    verdict.may = 0;
    verdict.sure = 0;
    for (std::size_t first = 0; first < triangles; first += kTrianglesAtOnce)
        judge_some_of_patch(rays, limits, ray, all, first, shown, verdict);
    const std::uint32_t there = (1u << triangles) - 1u;
    verdict.may &= there;
    verdict.sure &= there;
}

// A triangle that ray `ray` surely hits between the two: as take() of a vector of rays.
template <typename Shape>
HWY_INLINE void take_one(ClosestOfGroup& search, std::size_t ray, float from, float to,
                         Taken<Shape>& taken) {
    if (from > search.limits.t_far[ray]) return;  // behind what was taken since it was judged
    if (!taken.enter(search)) {
        search.add_rival(ray, taken.object, taken.primitive);
        return;
    }
    const float window = to * kBeyondTie;
    search.limits.t_far[ray] = std::min(search.limits.t_far[ray], window);
    if (!(window < search.candidate_from[ray])) {
        search.add_rival(ray, taken.object, taken.primitive);
        return;
    }
    search.candidate_from[ray] = from;
    search.candidate[ray] = taken.place;
    search.found |= RayMask{1} << ray;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
