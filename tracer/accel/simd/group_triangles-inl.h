// Triangles against a group of rays, in float with bounds on the rounding errors: surely hit,
// surely missed, or left to intersect_triangle. Included once for each instruction set.
#if defined(RAYPICK_GROUP_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_TRIANGLES_INL_H
#undef RAYPICK_GROUP_TRIANGLES_INL_H
#else
#define RAYPICK_GROUP_TRIANGLES_INL_H
#endif

#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/ray_group-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/simd/triangle_bounds-inl.h"
#include "tracer/scene/scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What is the same for all rays of a group, of a patch's triangles. With a, b, c the corners, o a
// ray's origin and d its direction, the ray's edge functions are
//   U = d . ((b - o) x (c - b)),  V = d . ((c - o) x (a - c)),  W = d . ((a - o) x (b - a)),
// of one sign within the triangle, and with n = (b - a) x (c - a)
//   t = n . (a - o) / (n . d),  U + V + W = n . d.
// In float (u = 2^-24), for offsets from o of at most R, edges of at most e and |d| of at most D:
// a product's component is wrong by at most 8 u R e, an edge function by 3 D 8 u R e + 9 u D 2 R e
// < 64 u D R e; n by 7 u e^2, n . d by less than 48 u D e^2, and n . (a - o) by less than 48 u R
// e^2.
struct GroupTriangles {
    using Numbers = std::array<float, TrianglePatch::kMostTriangles>;
    using Vectors = std::array<Numbers, 3>;  // by axis

    HWY_ALIGN Vectors a;
    HWY_ALIGN Vectors edge_b;  // b - a
    HWY_ALIGN Vectors edge_c;  // c - a
    HWY_ALIGN Vectors n;
    HWY_ALIGN Numbers edge_error;
    HWY_ALIGN Numbers slope_error;   // of n . d
    HWY_ALIGN Numbers height_error;  // of n . (a - o)
    // Backwards: what a ray adds to that with each unit of its a - o.
    HWY_ALIGN Numbers height_growth;
    // Of one origin only.
    HWY_ALIGN Vectors u;
    HWY_ALIGN Vectors v;
    HWY_ALIGN Vectors w;
    HWY_ALIGN Numbers height;  // n . (a - o)
};

struct TriangleVectors {
    TriangleFloats x, y, z;

    HWY_INLINE TriangleVectors operator-(const TriangleVectors& other) const {
        return {hn::Sub(x, other.x), hn::Sub(y, other.y), hn::Sub(z, other.z)};
    }
};

HWY_INLINE TriangleVectors cross(const TriangleVectors& p, const TriangleVectors& q) {
    return {hn::NegMulAdd(p.z, q.y, hn::Mul(p.y, q.z)), hn::NegMulAdd(p.x, q.z, hn::Mul(p.z, q.x)),
            hn::NegMulAdd(p.y, q.x, hn::Mul(p.x, q.y))};
}

HWY_INLINE TriangleFloats largest_of(const TriangleVectors& v) {
    return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

HWY_INLINE void store(const TriangleVectors& from, std::size_t first, GroupTriangles::Vectors& to) {
    const Triangles d;
    hn::Store(from.x, d, to[0].data() + first);
    hn::Store(from.y, d, to[1].data() + first);
    hn::Store(from.z, d, to[2].data() + first);
}

// Corners of a patch's triangles from `first` on, as many as one instruction takes.
struct PatchCorners {
    TriangleVectors a, b, c;

    HWY_INLINE PatchCorners(const TrianglePatch& patch, std::size_t first)
        : a(pick(patch, 0, first)), b(pick(patch, 1, first)), c(pick(patch, 2, first)) {}

private:
    static HWY_INLINE TriangleVectors pick(const TrianglePatch& patch, std::size_t k,
                                           std::size_t first) {
        const CornerPick corner(patch, k, first);
        return {corner.of(patch.along(0)), corner.of(patch.along(1)), corner.of(patch.along(2))};
    }
};

// e of each.
HWY_INLINE TriangleFloats longest_edge(const PatchCorners& corners, const TriangleVectors& edge_b,
                                       const TriangleVectors& edge_c) {
    return hn::Max(hn::Max(largest_of(edge_b), largest_of(edge_c)),
                   largest_of(corners.c - corners.b));
}

inline constexpr float kUnitError = 0x1p-24f;  // u
inline constexpr float kTinyError = 16.0f * std::numeric_limits<float>::min();
// With several origins U is taken from the other functions: three of their errors.
inline constexpr float kOriginsApart = 192.0f;

// `factor` is the bound's own, 64 or kOriginsApart, times D.
HWY_INLINE TriangleFloats edge_error_of(TriangleFloats edge_reach, float factor) {
    const Triangles d;
    return hn::MulAdd(edge_reach, hn::Set(d, factor * kUnitError), hn::Set(d, kTinyError));
}
HWY_INLINE TriangleFloats slope_error_of(TriangleFloats edge, float steepest) {
    const Triangles d;
    return hn::MulAdd(hn::Mul(edge, edge), hn::Set(d, 48.0f * kUnitError * steepest),
                      hn::Set(d, kTinyError));
}
HWY_INLINE TriangleFloats height_growth_of(TriangleFloats edge) {
    return hn::Mul(hn::Mul(edge, edge), hn::Set(Triangles(), 48.0f * kUnitError));
}
HWY_INLINE TriangleFloats height_error_of(TriangleFloats edge, TriangleFloats reach) {
    return hn::MulAdd(height_growth_of(edge), reach, hn::Set(Triangles(), kTinyError));
}

// Of an edge function of direction the bounds that hold for all rays.
struct EdgeBounds {
    TriangleFloats low, high;
};

HWY_INLINE EdgeBounds edge_bounds(const GroupSpace& space, const TriangleVectors& normal) {
    const Triangles d;
    const auto along = [&](const TriangleFloats& n, std::size_t axis, EdgeBounds& sum) HWY_ATTR {
        const auto at_low = hn::Mul(n, hn::Set(d, space.direction_low[axis]));
        const auto at_high = hn::Mul(n, hn::Set(d, space.direction_high[axis]));
        sum.low = hn::Add(sum.low, hn::Min(at_low, at_high));
        sum.high = hn::Add(sum.high, hn::Max(at_low, at_high));
    };
    EdgeBounds bounds{hn::Zero(d), hn::Zero(d)};
    along(normal.x, 0, bounds);
    along(normal.y, 1, bounds);
    along(normal.z, 2, bounds);
    return bounds;
}

// Triangles whose boxes some ray of the group may meet before t_far, as a mask; see meet_group().
HWY_INLINE std::uint32_t meet_boxes(const GroupSpace& space, const PatchCorners& corners,
                                    float t_far) {
    const Triangles d;
    auto near = hn::Set(d, space.t_least());
    auto far = hn::Set(d, t_far);
    const auto meet = [&](std::size_t axis, const TriangleFloats& a, const TriangleFloats& b,
                          const TriangleFloats& c) HWY_ATTR {
        const auto least = hn::Min(hn::Min(a, b), c);
        const auto most = hn::Max(hn::Max(a, b), c);
        const bool negative = space.first[axis] >= 3;
        const auto met =
            meet_slabs(d, space, axis, negative ? most : least, negative ? least : most);
        near = hn::Max(near, met.near_least);
        far = hn::Min(far, met.far_most);
    };
    meet(0, corners.a.x, corners.b.x, corners.c.x);
    meet(1, corners.a.y, corners.b.y, corners.c.y);
    meet(2, corners.a.z, corners.b.z, corners.c.z);
    return triangle_bits(
        hn::Le(hn::Mul(near, hn::Set(d, kShrinkGroup)), hn::Mul(far, hn::Set(d, kGrowGroup))));
}

// Sets the triangles of the patch from `first` on, as many as one instruction takes, and returns
// those that some ray of the group may meet before t_far, as a mask. With one origin the edges tell
// that better than the boxes do. If that is none of the whole patch, they may be left as they were.
HWY_INLINE std::uint32_t set_triangles(const GroupSpace& space, float t_far,
                                       const TrianglePatch& patch, std::size_t first,
                                       GroupTriangles& triangles) {
    const Triangles d;
    const PatchCorners corners(patch, first);
    std::uint32_t met = 0;
    if (!space.one_origin) {
        met = meet_boxes(space, corners, t_far);
        if (met == 0 && kTrianglesAtOnce == TrianglePatch::kMostTriangles) return 0;
    }
    const auto& [a, b, c] = corners;
    const TriangleVectors edge_b = b - a;
    const TriangleVectors edge_c = c - a;
    const TriangleVectors n = cross(edge_b, edge_c);
    const TriangleVectors low{hn::Set(d, space.origin_low[0]), hn::Set(d, space.origin_low[1]),
                              hn::Set(d, space.origin_low[2])};
    const TriangleVectors high{hn::Set(d, space.origin_high[0]), hn::Set(d, space.origin_high[1]),
                               hn::Set(d, space.origin_high[2])};
    const auto edge = longest_edge(corners, edge_b, edge_c);
    const auto reach = hn::Add(hn::Max(largest_of(a - low), largest_of(a - high)), edge);
    const auto rounded = hn::Mul(edge, hn::Add(reach, hn::Set(d, space.origin_rounding)));
    const auto edge_error = edge_error_of(
        rounded, (space.one_origin ? 64.0f : kOriginsApart) * space.steepest_direction);
    store(a, first, triangles.a);
    store(edge_b, first, triangles.edge_b);
    store(edge_c, first, triangles.edge_c);
    store(n, first, triangles.n);
    hn::Store(edge_error, d, triangles.edge_error.data() + first);
    hn::Store(slope_error_of(edge, space.steepest_direction), d,
              triangles.slope_error.data() + first);
    const auto from_origin = space.course.backwards()
                                 ? hn::Set(d, space.forward_rounding)
                                 : hn::Add(reach, hn::Set(d, space.origin_rounding));
    hn::Store(height_error_of(edge, from_origin), d, triangles.height_error.data() + first);
    hn::Store(height_growth_of(edge), d, triangles.height_growth.data() + first);
    if (!space.one_origin) return met;
    const TriangleVectors from_a = a - low;
    const TriangleVectors u = cross(b - low, c - b);
    const TriangleVectors v = cross(edge_c, c - low);
    const TriangleVectors w = cross(from_a, edge_b);
    store(u, first, triangles.u);
    store(v, first, triangles.v);
    store(w, first, triangles.w);
    hn::Store(hn::MulAdd(n.x, from_a.x, hn::MulAdd(n.y, from_a.y, hn::Mul(n.z, from_a.z))), d,
              triangles.height.data() + first);
    // Missed by all, if one edge function is surely below 0 for all, and another surely above.
    const EdgeBounds of_u = edge_bounds(space, u);
    const EdgeBounds of_v = edge_bounds(space, v);
    const EdgeBounds of_w = edge_bounds(space, w);
    const auto least = hn::Min(hn::Min(of_u.high, of_v.high), of_w.high);
    const auto most = hn::Max(hn::Max(of_u.low, of_v.low), of_w.low);
    const auto error = hn::Add(edge_error, edge_error);
    const auto missed = hn::And(hn::Lt(least, hn::Neg(error)), hn::Gt(most, error));
    return ~triangle_bits(missed) & ((1u << kTrianglesAtOnce) - 1u);
}

// One of a patch's triangles.
struct GroupTriangle {
    const GroupTriangles& all;
    const TrianglePatch& patch;
    std::size_t i;
};

inline void keep_corners(const TrianglePatch& patch, std::size_t i, const Instance& instance,
                         Candidate& candidate) {
    candidate.instance = &instance;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 p = patch.position(static_cast<std::uint32_t>(i), k);
        candidate.corners[static_cast<std::size_t>(k)] = {p.x, p.y, p.z, 0.0f};
    }
}
inline void keep(const GroupTriangle& triangle, const Instance& instance, Candidate& candidate) {
    keep_corners(triangle.patch, triangle.i, instance, candidate);
}
// Of what is no triangle there is nothing to keep.
template <typename Shape>
void keep(const Shape& /*shape*/, const Instance& /*instance*/, Candidate& /*candidate*/) {}

HWY_INLINE RayFloats dot(const GroupTriangles::Vectors& constant, std::size_t i, const RayFloats& x,
                         const RayFloats& y, const RayFloats& z) {
    const Rays d;
    return hn::MulAdd(
        hn::Set(d, constant[0][i]), x,
        hn::MulAdd(hn::Set(d, constant[1][i]), y, hn::Mul(hn::Set(d, constant[2][i]), z)));
}

HWY_INLINE EdgeFunctions<RayFloats> edge_functions(const GroupSpace& space,
                                                   const GroupTriangle& triangle, std::size_t ray) {
    const Rays d;
    const GroupTriangles& all = triangle.all;
    const std::size_t i = triangle.i;
    const auto dx = hn::Load(d, space.rays.direction[0].data() + ray);
    const auto dy = hn::Load(d, space.rays.direction[1].data() + ray);
    const auto dz = hn::Load(d, space.rays.direction[2].data() + ray);
    EdgeFunctions<RayFloats> f;
    f.slope = dot(all.n, i, dx, dy, dz);
    if (space.one_origin) {
        f.u = dot(all.u, i, dx, dy, dz);
        f.v = dot(all.v, i, dx, dy, dz);
        f.w = dot(all.w, i, dx, dy, dz);
        f.height = hn::Set(d, all.height[i]);
        return f;
    }
    const auto x = hn::Sub(hn::Set(d, all.a[0][i]), hn::Load(d, space.rays.origin[0].data() + ray));
    const auto y = hn::Sub(hn::Set(d, all.a[1][i]), hn::Load(d, space.rays.origin[1].data() + ray));
    const auto z = hn::Sub(hn::Set(d, all.a[2][i]), hn::Load(d, space.rays.origin[2].data() + ray));
    const auto rx = hn::NegMulAdd(dz, y, hn::Mul(dy, z));
    const auto ry = hn::NegMulAdd(dx, z, hn::Mul(dz, x));
    const auto rz = hn::NegMulAdd(dy, x, hn::Mul(dx, y));
    f.v = hn::Neg(dot(all.edge_c, i, rx, ry, rz));
    f.w = dot(all.edge_b, i, rx, ry, rz);
    f.u = hn::Sub(f.slope, hn::Add(f.v, f.w));
    f.height = dot(all.n, i, x, y, z);
    return f;
}

HWY_INLINE Height<RayFloats> height_above(const GroupSpace& space, const GroupTriangle& triangle,
                                          const EdgeFunctions<RayFloats>& f, std::size_t ray) {
    const Rays d;
    const GroupTriangles& all = triangle.all;
    const std::size_t i = triangle.i;
    if (!space.course.backwards()) return {f.height, hn::Set(d, all.height_error[i])};
    const auto& origin = space.course.forward->origin;
    const auto x = hn::Sub(hn::Load(d, origin[0].data() + ray), hn::Set(d, all.a[0][i]));
    const auto y = hn::Sub(hn::Load(d, origin[1].data() + ray), hn::Set(d, all.a[1][i]));
    const auto z = hn::Sub(hn::Load(d, origin[2].data() + ray), hn::Set(d, all.a[2][i]));
    const auto reach = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    return {dot(all.n, i, x, y, z),
            hn::MulAdd(reach, hn::Set(d, all.height_growth[i]), hn::Set(d, all.height_error[i]))};
}

// The mask's rays that may meet the triangle on a side that is shown, by their edge functions
// alone.
HWY_INLINE RayMask within_edges(const GroupSpace& space, const GroupTriangle& triangle,
                                const ShownSides& shown, RayMask mask) {
    const auto error = hn::Set(Rays(), triangle.all.edge_error[triangle.i]);
    // Of the two that a ray is asked for, one may be given.
    RayMask below = shown.back ? 0 : ~RayMask{0};
    RayMask above = shown.front ? 0 : ~RayMask{0};
    every_vector(mask, [&](std::size_t ray, RayMask /*bits*/) HWY_ATTR {
        const EdgeBounded<Rays> edges(edge_functions(space, triangle, ray), error);
        below |= ray_bits(edges.below()) << ray;
        above |= ray_bits(edges.above()) << ray;
    });
    return mask & ~(below & above);
}

// Triangles of a patch, each with vectors of rays that may meet it. All in one list, and without a
// branch: it can't be foretold how many there are of each.
class PatchPairs {
public:
    HWY_INLINE void add(std::size_t triangle, RayMask rays) {
        rays_[triangle] = rays;
        if constexpr (kVectors > 8) {
            each_vector(rays, [&](std::size_t ray, RayMask /*bits*/) HWY_ATTR {
                pairs_[count_++] = static_cast<Pair>(triangle * kVectors + ray / kAtOnce);
            });
            return;
        }
        for (std::size_t k = 0; k < kVectors; ++k) {
            pairs_[count_] = static_cast<Pair>(triangle * kVectors + k);
            count_ += ((rays >> k * kAtOnce) & kAllAtOnce) != 0 ? 1u : 0u;
        }
    }

    // Calls body(triangle, first ray, its rays from there on).
    template <typename Body>
    HWY_INLINE void each(const Body& body) const {
        for (std::size_t i = 0; i < count_; ++i) {
            const std::size_t triangle = pairs_[i] / kVectors;
            const std::size_t ray = pairs_[i] % kVectors * kAtOnce;
            body(triangle, ray, (rays_[triangle] >> ray) & kAllAtOnce);
        }
    }

private:
    static constexpr std::size_t kVectors = kGroup / kAtOnce;
    using Pair = std::uint16_t;

    std::array<RayMask, TrianglePatch::kMostTriangles> rays_;
    std::array<Pair, TrianglePatch::kMostTriangles * kVectors> pairs_;
    std::size_t count_ = 0;
};

// What the bounds say of a vector of rays.
struct Verdict {
    RayMask may = 0;   // hit
    RayMask sure = 0;  // to hit, of those
    RayFloats from;    // t is at least this; of the sure ones
    RayFloats to;
};

HWY_INLINE Verdict judge(const GroupSpace& space, const GroupLimits& limits,
                         const GroupTriangle& triangle, const ShownSides& shown, std::size_t ray) {
    const Rays d;
    const EdgeFunctions<RayFloats> f = edge_functions(space, triangle, ray);
    const GroupTriangles& all = triangle.all;
    const EdgeBounded<Rays> edges(f, hn::Set(d, all.edge_error[triangle.i]));
    Verdict verdict;
    verdict.may = ~ray_bits(edges.misses(shown)) & kAllAtOnce;
    if (verdict.may == 0) return verdict;
    const PlaneBounded<Rays> plane(f.slope, hn::Set(d, all.slope_error[triangle.i]),
                                   height_above(space, triangle, f, ray));
    const auto t_min = hn::Load(d, limits.t_min.data() + ray);
    const auto t_far = hn::Load(d, limits.t_far.data() + ray);
    verdict.may &= ~ray_bits(plane.misses(t_min, t_far));
    if (verdict.may == 0) return verdict;
    verdict.from = plane.from();
    verdict.to = plane.to();
    const auto sure =
        hn::And(edges.surely_within(), plane.surely_within(verdict.from, verdict.to, t_min, t_far));
    verdict.sure = verdict.may & ray_bits(sure);
    return verdict;
}

// A primitive on its way into the candidates: it gets there with the first ray that it is one of.
template <typename Shape>
struct Taken {
    const Shape& shape;
    const Instance& instance;
    std::uint32_t object;  // index
    std::uint32_t primitive;
    std::uint32_t place = ClosestOfGroup::kMostCandidates;

    // False if there is no room.
    HWY_INLINE bool enter(ClosestOfGroup& search) {
        if (place < ClosestOfGroup::kMostCandidates) return true;
        if (search.full()) return false;
        place = search.candidate_count;
        keep(shape, instance, search.add_candidate(object, primitive));
        return true;
    }
};

// Of the mask's rays in a vector those that surely hit: keeps them in place where they stand before
// what was found, and makes rivals of the others. Returns those that may hit or not.
template <typename Shape>
HWY_INLINE RayMask take(ClosestOfGroup& search, const Verdict& verdict, std::size_t ray,
                        RayMask bits, Taken<Shape>& taken) {
    const Rays d;
    const hn::Rebind<std::uint32_t, Rays> du;
    const RayMask may = verdict.may & bits;
    const RayMask sure = taken.instance.holes ? 0 : verdict.sure & bits;
    RayMask rivals = sure;
    if (sure != 0 && taken.enter(search)) {
        const auto from = hn::Load(d, search.candidate_from.data() + ray);
        const auto far = hn::Load(d, search.limits.t_far.data() + ray);
        const auto window = hn::Mul(verdict.to, hn::Set(d, kBeyondTie));
        const RayMask first = sure & ray_bits(hn::Lt(window, from));
        const auto keep = ray_mask(first);
        hn::BlendedStore(verdict.from, keep, d, search.candidate_from.data() + ray);
        hn::BlendedStore(hn::Set(du, taken.place), hn::RebindMask(du, keep), du,
                         search.candidate.data() + ray);
        hn::BlendedStore(hn::Min(far, window), ray_mask(sure), d, search.limits.t_far.data() + ray);
        search.found |= first << ray;
        rivals &= ~first;
    }
    each_ray(rivals, [&](std::size_t i)
                         HWY_ATTR { search.add_rival(ray + i, taken.object, taken.primitive); });
    return may & ~sure;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
