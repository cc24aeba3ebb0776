// Single rays of a group against all triangles of a patch at once. Included once for each
// instruction set.
#if defined(RAYPICK_RAY_PATCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_PATCHES_INL_H
#undef RAYPICK_RAY_PATCHES_INL_H
#else
#define RAYPICK_RAY_PATCHES_INL_H
#endif

#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/ray_verdict-inl.h"
#include "tracer/accel/simd/triangle_bounds-inl.h"

#include <bit>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Where a vector of rays has many gaps and a patch has few, this takes fewer lanes. The other way
// is quicker for as many, and vectors of sixteen rays take no longer than two of eight triangles.
// `left` are the triangles that the other way would have to look at.
inline bool better_ray_by_ray(const TrianglePatch& patch, std::uint32_t left, RayMask mask) {
    std::size_t vectors = 0;
    each_vector(mask, [&](std::size_t, RayMask) HWY_ATTR { ++vectors; });
    const std::size_t triangles = patch.triangles;
    const std::size_t padded =
        (triangles + kTrianglesAtOnce - 1) / kTrianglesAtOnce * kTrianglesAtOnce;
    const auto rays = static_cast<std::size_t>(std::popcount(mask));
    constexpr std::size_t kHalves = kAtOnce > 8 ? 4 : 3;
    return kHalves * rays * padded <
           2 * static_cast<std::size_t>(std::popcount(left)) * vectors * kAtOnce;
}

static_assert(TrianglePatch::kMostTriangles <= RayVerdict::kMost);

// Of the triangles that a ray may hit, those that don't just let it go on.
template <typename Group>
HWY_INLINE std::uint32_t not_crossed(Group& search, std::uint32_t object,
                                     const TrianglePatch& patch, std::uint32_t may,
                                     std::size_t ray) {
    std::uint32_t others = may;
    each_bit(may, [&](std::size_t i) HWY_ATTR {
        if (crossed(search, object, patch.primitives()[i], RayMask{1} << ray)) others &= ~(1u << i);
    });
    return others;
}

HWY_INLINE TriangleFloats dots(const GroupTriangles::Vectors& v, std::size_t first,
                               const TriangleFloats& x, const TriangleFloats& y,
                               const TriangleFloats& z) {
    const Triangles d;
    const auto load = [&](std::size_t axis)
                          HWY_ATTR { return hn::Load(d, v[axis].data() + first); };
    return hn::MulAdd(load(0), x, hn::MulAdd(load(1), y, hn::Mul(load(2), z)));
}

// As edge_functions() of a vector of rays.
HWY_INLINE EdgeFunctions<TriangleFloats> edge_functions_of_ray(const GroupSpace& space,
                                                               std::size_t ray,
                                                               const GroupTriangles& all,
                                                               std::size_t first) {
    const Triangles d;
    const GroupRays& rays = space.rays;
    const auto dx = hn::Set(d, rays.direction[0][ray]);
    const auto dy = hn::Set(d, rays.direction[1][ray]);
    const auto dz = hn::Set(d, rays.direction[2][ray]);
    EdgeFunctions<TriangleFloats> f;
    f.slope = dots(all.n, first, dx, dy, dz);
    if (space.one_origin) {
        f.u = dots(all.u, first, dx, dy, dz);
        f.v = dots(all.v, first, dx, dy, dz);
        f.w = dots(all.w, first, dx, dy, dz);
        f.height = hn::Load(d, all.height.data() + first);
        return f;
    }
    const auto from_origin = [&](std::size_t axis) HWY_ATTR {
        return hn::Sub(hn::Load(d, all.a[axis].data() + first), hn::Set(d, rays.origin[axis][ray]));
    };
    const auto x = from_origin(0);
    const auto y = from_origin(1);
    const auto z = from_origin(2);
    const auto rx = hn::NegMulAdd(dz, y, hn::Mul(dy, z));
    const auto ry = hn::NegMulAdd(dx, z, hn::Mul(dz, x));
    const auto rz = hn::NegMulAdd(dy, x, hn::Mul(dx, y));
    f.v = hn::Neg(dots(all.edge_c, first, rx, ry, rz));
    f.w = dots(all.edge_b, first, rx, ry, rz);
    f.u = hn::Sub(f.slope, hn::Add(f.v, f.w));
    f.height = dots(all.n, first, x, y, z);
    return f;
}

// How wrong they may be.
struct TriangleErrors {
    TriangleFloats edge, slope, height;
};

// What the bounds say of as many triangles as one instruction takes, as bits from `first` on.
struct SomeVerdict {
    std::uint32_t may = 0;
    std::uint32_t sure = 0;
};

// Sets the numbers of the sure ones.
HWY_INLINE SomeVerdict judge_functions(const EdgeFunctions<TriangleFloats>& f,
                                       const TriangleErrors& errors, float t_min, float t_far,
                                       const ShownSides& shown, std::size_t first,
                                       RayVerdict& verdict) {
    const Triangles d;
    const EdgeBounded<Triangles> edges(f, errors.edge);
    const PlaneBounded<Triangles> plane(f.slope, errors.slope,
                                        Height<TriangleFloats>{f.height, errors.height});
    const auto least = hn::Set(d, t_min);
    const auto most = hn::Set(d, t_far);
    const std::uint32_t may =
        ~triangle_bits(hn::Or(edges.misses(shown), plane.misses(least, most))) &
        ((1u << kTrianglesAtOnce) - 1u);
    const auto from = plane.from();
    const auto to = plane.to();
    const auto sure = hn::And(edges.surely_within(), plane.surely_within(from, to, least, most));
    hn::Store(from, d, verdict.from.data() + first);
    hn::Store(to, d, verdict.to.data() + first);
    return {may << first, (may & triangle_bits(sure)) << first};
}

// judge_some(first) is asked for all triangles of a patch.
template <typename Some>
HWY_INLINE void judge_all_of_patch(std::size_t triangles, RayVerdict& verdict,
                                   const Some& judge_some) {
    SomeVerdict all;
    for (std::size_t first = 0; first < triangles; first += kTrianglesAtOnce) {
        const SomeVerdict some = judge_some(first);
        all.may |= some.may;
        all.sure |= some.sure;
    }
    const std::uint32_t there = (1u << triangles) - 1u;
    verdict.may = all.may & there;
    verdict.sure = all.sure & there;
}

// Of rays that are followed forwards.
HWY_INLINE void judge_patch_of_ray(const GroupSpace& space, const GroupLimits& limits,
                                   std::size_t ray, const GroupTriangles& all,
                                   std::size_t triangles, const ShownSides& shown,
                                   RayVerdict& verdict) {
    judge_all_of_patch(triangles, verdict, [&](std::size_t first) HWY_ATTR {
        const Triangles d;
        const TriangleErrors errors{hn::Load(d, all.edge_error.data() + first),
                                    hn::Load(d, all.slope_error.data() + first),
                                    hn::Load(d, all.height_error.data() + first)};
        return judge_functions(edge_functions_of_ray(space, ray, all, first), errors,
                               limits.t_min[ray], limits.t_far[ray], shown, first, verdict);
    });
}

HWY_INLINE TriangleFloats dot(const TriangleVectors& p, const TriangleVectors& q) {
    return hn::MulAdd(p.x, q.x, hn::MulAdd(p.y, q.y, hn::Mul(p.z, q.z)));
}

HWY_INLINE TriangleVectors same(const glm::vec3& v) {
    const Triangles d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

// The same of a ray that meets the patch alone: what set_triangles would keep for others stays in
// registers. `steepest` is the direction's largest component; the patch is in the ray's space.
HWY_INLINE void judge_patch_alone(const Ray& ray, float steepest, float t_far,
                                  const TrianglePatch& patch, const ShownSides& shown,
                                  RayVerdict& verdict) {
    judge_all_of_patch(patch.triangles, verdict, [&](std::size_t first) HWY_ATTR {
        const PatchCorners corners(patch, first);
        const TriangleVectors edge_b = corners.b - corners.a;
        const TriangleVectors edge_c = corners.c - corners.a;
        const TriangleVectors n = cross(edge_b, edge_c);
        const TriangleVectors from_origin = corners.a - same(ray.origin);
        const TriangleVectors direction = same(ray.direction);
        const TriangleVectors r = cross(direction, from_origin);
        const auto edge = longest_edge(corners, edge_b, edge_c);
        const auto reach = hn::Add(largest_of(from_origin), edge);
        EdgeFunctions<TriangleFloats> f;
        f.slope = dot(n, direction);
        f.v = hn::Neg(dot(edge_c, r));
        f.w = dot(edge_b, r);
        f.u = hn::Sub(f.slope, hn::Add(f.v, f.w));
        f.height = dot(n, from_origin);
        const TriangleErrors errors{edge_error_of(hn::Mul(edge, reach), kOriginsApart * steepest),
                                    slope_error_of(edge, steepest), height_error_of(edge, reach)};
        return judge_functions(f, errors, ray.t_min, t_far, shown, first, verdict);
    });
}

// True if what a ray surely hits between the two surely stands before its candidate, whose place it
// is to take then; else it has become a rival.
HWY_INLINE bool precedes_candidate(ClosestOfGroup& search, std::size_t ray, float from, float to,
                                   std::uint32_t object, std::uint32_t primitive) {
    const float window = to * kBeyondTie;
    search.limits.t_far[ray] = std::min(search.limits.t_far[ray], window);
    if (!(window < search.candidate_from[ray])) {
        search.add_rival(ray, object, primitive);
        return false;
    }
    search.candidate_from[ray] = from;
    search.found |= RayMask{1} << ray;
    return true;
}

// A triangle that ray `ray` surely hits between the two: as take() of a vector of rays.
template <typename Shape>
HWY_INLINE void take_one(ClosestOfGroup& search, std::size_t ray, float from, float to,
                         Taken<Shape>& taken) {
    if (from > search.limits.t_far[ray]) return;  // behind what was taken since it was judged
    if (!taken.enter(search)) {
        search.add_rival(ray, taken.object, taken.primitive);
    } else if (precedes_candidate(search, ray, from, to, taken.object, taken.primitive)) {
        search.candidate[ray] = taken.place;
    }
}

// The same of what ray `ray` met alone, in a place that is the ray's own. Returns that, if it took
// it.
HWY_INLINE Candidate* take_alone(ClosestOfGroup& search, std::size_t ray, float from, float to,
                                 std::uint32_t object, std::uint32_t primitive) {
    if (from > search.limits.t_far[ray]) return nullptr;
    if (!precedes_candidate(search, ray, from, to, object, primitive)) return nullptr;
    const std::size_t place = ClosestOfGroup::kMostCandidates + ray;
    search.candidate[ray] = static_cast<std::uint32_t>(place);
    search.in_own_place |= RayMask{1} << ray;
    search.candidates[place].object = object;
    search.candidates[place].primitive = primitive;
    search.candidates[place].instance = nullptr;
    return &search.candidates[place];
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
