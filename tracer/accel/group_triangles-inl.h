// Triangles against a group of rays, in float with bounds on the rounding errors: surely hit,
// surely missed, or left to intersect_triangle. Included once for each instruction set.
#if defined(RAYPICK_GROUP_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_TRIANGLES_INL_H
#undef RAYPICK_GROUP_TRIANGLES_INL_H
#else
#define RAYPICK_GROUP_TRIANGLES_INL_H
#endif

#include "tracer/accel/group_search-inl.h"
#include "tracer/accel/ray_group-inl.h"
#include "tracer/scene/scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline float largest_of(const glm::vec3& v) {
    const glm::vec3 a = glm::abs(v);
    return std::max({a.x, a.y, a.z});
}

// What is the same for all rays of a group. With a, b, c the corners, o a ray's origin and d its
// direction, the ray's edge functions are
//   U = d . ((b - o) x (c - b)),  V = d . ((c - o) x (a - c)),  W = d . ((a - o) x (b - a)),
// of one sign within the triangle, and with n = (b - a) x (c - a)
//   t = n . (a - o) / (n . d),  U + V + W = n . d.
// In float (u = 2^-24), for offsets from o of at most R, edges of at most e and |d| of at most D:
// a product's component is wrong by at most 8 u R e, an edge function by 3 D 8 u R e + 9 u D 2 R e
// < 64 u D R e; n by 7 u e^2, n . d by less than 48 u D e^2, and n . (a - o) by less than 48 u R
// e^2.
struct GroupTriangle {
    glm::vec3 a{0.0f};
    glm::vec3 edge_b{0.0f};  // b - a
    glm::vec3 edge_c{0.0f};  // c - a
    glm::vec3 n{0.0f};
    float edge_error = 0.0f;
    float slope_error = 0.0f;   // of n . d
    float height_error = 0.0f;  // of n . (a - o)
    // Of one origin only.
    glm::vec3 u{0.0f};
    glm::vec3 v{0.0f};
    glm::vec3 w{0.0f};
    float height = 0.0f;  // n . (a - o)
};

inline GroupTriangle group_triangle(const GroupSpace& space, const glm::vec3& a, const glm::vec3& b,
                                    const glm::vec3& c) {
    constexpr float kUnit = 0x1p-24f;
    constexpr float kTiny = 16.0f * std::numeric_limits<float>::min();
    GroupTriangle triangle;
    triangle.a = a;
    triangle.edge_b = b - a;
    triangle.edge_c = c - a;
    const glm::vec3 edge_bc = c - b;
    triangle.n = glm::cross(triangle.edge_b, triangle.edge_c);
    const glm::vec3 low(space.origin_low[0], space.origin_low[1], space.origin_low[2]);
    const glm::vec3 high(space.origin_high[0], space.origin_high[1], space.origin_high[2]);
    const float edge = largest_of(glm::max(
        glm::max(glm::abs(triangle.edge_b), glm::abs(triangle.edge_c)), glm::abs(edge_bc)));
    const float reach = std::max(largest_of(a - low), largest_of(a - high)) + edge;
    const float rounded = reach + space.origin_rounding;
    const float steepest = space.steepest_direction;
    // With several origins U is taken from the others: three of their errors.
    triangle.edge_error =
        (space.one_origin ? 64.0f : 192.0f) * kUnit * steepest * rounded * edge + kTiny;
    triangle.slope_error = 48.0f * kUnit * steepest * edge * edge + kTiny;
    triangle.height_error = 48.0f * kUnit * rounded * edge * edge + kTiny;
    if (space.one_origin) {
        const glm::vec3 from_a = a - low;
        const glm::vec3 from_b = b - low;
        const glm::vec3 from_c = c - low;
        triangle.u = glm::cross(from_b, edge_bc);
        triangle.v = -glm::cross(from_c, triangle.edge_c);
        triangle.w = glm::cross(from_a, triangle.edge_b);
        triangle.height = glm::dot(triangle.n, from_a);
    }
    return triangle;
}

struct EdgeFunctions {
    RayFloats u, v, w;
    RayFloats slope;   // n . d
    RayFloats height;  // n . (a - o)
};

HWY_INLINE RayFloats dot(const glm::vec3& constant, const RayFloats& x, const RayFloats& y,
                         const RayFloats& z) {
    const Rays d;
    return hn::MulAdd(hn::Set(d, constant.x), x,
                      hn::MulAdd(hn::Set(d, constant.y), y, hn::Mul(hn::Set(d, constant.z), z)));
}

HWY_INLINE EdgeFunctions edge_functions(const GroupSpace& space, const GroupTriangle& triangle,
                                        std::size_t ray) {
    const Rays d;
    const auto dx = hn::Load(d, space.rays.direction[0].data() + ray);
    const auto dy = hn::Load(d, space.rays.direction[1].data() + ray);
    const auto dz = hn::Load(d, space.rays.direction[2].data() + ray);
    EdgeFunctions f;
    f.slope = dot(triangle.n, dx, dy, dz);
    if (space.one_origin) {
        f.u = dot(triangle.u, dx, dy, dz);
        f.v = dot(triangle.v, dx, dy, dz);
        f.w = dot(triangle.w, dx, dy, dz);
        f.height = hn::Set(d, triangle.height);
        return f;
    }
    const auto x =
        hn::Sub(hn::Set(d, triangle.a.x), hn::Load(d, space.rays.origin[0].data() + ray));
    const auto y =
        hn::Sub(hn::Set(d, triangle.a.y), hn::Load(d, space.rays.origin[1].data() + ray));
    const auto z =
        hn::Sub(hn::Set(d, triangle.a.z), hn::Load(d, space.rays.origin[2].data() + ray));
    const auto rx = hn::NegMulAdd(dz, y, hn::Mul(dy, z));
    const auto ry = hn::NegMulAdd(dx, z, hn::Mul(dz, x));
    const auto rz = hn::NegMulAdd(dy, x, hn::Mul(dx, y));
    f.v = hn::Neg(dot(triangle.edge_c, rx, ry, rz));
    f.w = dot(triangle.edge_b, rx, ry, rz);
    f.u = hn::Sub(f.slope, hn::Add(f.v, f.w));
    f.height = dot(triangle.n, x, y, z);
    return f;
}

// What the bounds say of a vector of rays.
struct Verdict {
    RayMask may = 0;   // hit
    RayMask sure = 0;  // to hit, of those
    RayFloats from;    // t is at least this; of the sure ones
    RayFloats to;
};

struct ShownSides {
    bool front = true;
    bool back = true;
};

HWY_INLINE Verdict judge(const GroupSpace& space, const GroupLimits& limits,
                         const GroupTriangle& triangle, const ShownSides& shown, std::size_t ray) {
    const Rays d;
    const EdgeFunctions f = edge_functions(space, triangle, ray);
    const auto least = hn::Min(hn::Min(f.u, f.v), f.w);
    const auto most = hn::Max(hn::Max(f.u, f.v), f.w);
    const auto error = hn::Set(d, triangle.edge_error);
    const auto no = hn::Gt(least, hn::Set(d, std::numeric_limits<float>::infinity()));
    // Arranged so that a NaN rules nothing out. A ray that meets the front goes against n.
    auto missed = hn::Or(no, hn::And(hn::Lt(least, hn::Neg(error)), hn::Gt(most, error)));
    if (!shown.front) missed = hn::Lt(least, hn::Neg(error));
    if (!shown.back) missed = hn::Gt(most, error);
    Verdict verdict;
    constexpr RayMask kAll = (RayMask{1} << hn::MaxLanes(Rays())) - 1;
    verdict.may = ~ray_bits(missed) & kAll;
    if (verdict.may == 0) return verdict;
    const auto slope = hn::Abs(f.slope);
    const auto height = hn::Xor(f.height, hn::And(f.slope, hn::SignBit(d)));
    const auto slope_error = hn::Set(d, triangle.slope_error);
    const auto height_error = hn::Set(d, triangle.height_error);
    const auto t_min = hn::Load(d, limits.t_min.data() + ray);
    const auto t_far = hn::Load(d, limits.t_far.data() + ray);
    const auto grow = hn::Set(d, kGrowGroup);
    const auto shrink = hn::Set(d, kShrinkGroup);
    const auto steep = hn::Add(slope, slope_error);
    const auto beyond = hn::Or(hn::Lt(t_far, t_min), hn::Gt(hn::Sub(height, height_error),
                                                            hn::Mul(hn::Mul(t_far, grow), steep)));
    const auto flat = hn::Sub(slope, slope_error);
    const auto before =
        hn::And(hn::Gt(flat, hn::Zero(d)),
                hn::Lt(hn::Add(height, height_error), hn::Mul(hn::Mul(t_min, shrink), flat)));
    verdict.may &= ~ray_bits(hn::Or(beyond, before));
    if (verdict.may == 0) return verdict;
    verdict.from = hn::Mul(hn::Div(hn::Sub(height, height_error), steep), shrink);
    verdict.to = hn::Mul(hn::Div(hn::Add(height, height_error), flat), grow);
    auto sure = hn::Or(hn::Gt(least, error), hn::Lt(most, hn::Neg(error)));
    sure = hn::And(sure, hn::Gt(slope, hn::Mul(slope_error, hn::Set(d, 8.0f))));
    sure = hn::And(sure, hn::And(hn::Gt(verdict.from, t_min), hn::Lt(verdict.to, t_far)));
    verdict.sure = verdict.may & ray_bits(sure);
    return verdict;
}

// Of the mask's rays in a vector those that may hit: keeps the sure ones in place where they stand
// before what was found, and makes rivals of the others.
HWY_INLINE void take(ClosestOfGroup& search, const Verdict& verdict, std::size_t ray, RayMask bits,
                     std::uint32_t object, std::uint32_t primitive, bool holes) {
    const Rays d;
    const hn::Rebind<std::uint32_t, Rays> du;
    const RayMask may = verdict.may & bits;
    RayMask rivals = may;
    const RayMask sure = holes ? 0 : verdict.sure & bits;
    if (sure != 0) {
        const auto from = hn::Load(d, search.candidate_from.data() + ray);
        const auto far = hn::Load(d, search.limits.t_far.data() + ray);
        const auto window = hn::Mul(verdict.to, hn::Set(d, kBeyondTie));
        const RayMask first = sure & ray_bits(hn::Lt(window, from));
        std::uint8_t stored[8] = {static_cast<std::uint8_t>(first),
                                  static_cast<std::uint8_t>(first >> 8)};
        const auto keep = hn::LoadMaskBits(d, stored);
        hn::BlendedStore(verdict.from, keep, d, search.candidate_from.data() + ray);
        hn::BlendedStore(hn::Set(du, object), hn::RebindMask(du, keep), du,
                         search.candidate_object.data() + ray);
        hn::BlendedStore(hn::Set(du, primitive), hn::RebindMask(du, keep), du,
                         search.candidate_primitive.data() + ray);
        std::uint8_t stored_sure[8] = {static_cast<std::uint8_t>(sure),
                                       static_cast<std::uint8_t>(sure >> 8)};
        hn::BlendedStore(hn::Min(far, window), hn::LoadMaskBits(d, stored_sure), d,
                         search.limits.t_far.data() + ray);
        search.found |= first << ray;
        rivals &= ~first;
    }
    each_ray(rivals, [&](std::size_t i) HWY_ATTR { search.add_rival(ray + i, object, primitive); });
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
