#include "tracer/accel/triangle_surfaces.h"

#include <variant>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/triangle_surfaces.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "tracer/accel/simd/surface_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// As many hits as a vector holds, from lane i on.
class TriangleLanes {
public:
    HWY_INLINE TriangleLanes(const TriangleSurfaces::Inputs& in, SurfaceRows& rows, std::size_t i)
        : lanes_(rows, i), first_(&in.row[i]) {}

    // Returns bits of those that lie far from the edges.
    HWY_INLINE std::uint32_t find() const {
        using In = TriangleSurfaces;
        const V3 a = of_triangle3(In::kCorners);
        const V3 b = of_triangle3(In::kCorners + 3);
        const V3 c = of_triangle3(In::kCorners + 6);
        const V3 origin = lanes_.of_ray3(SurfaceRows::kOrigin);
        const V3 direction = lanes_.of_ray3(SurfaceRows::kDirection);
        const V u = of_triangle(In::kU);
        const V v = of_triangle(In::kV);
        const V3 edge_b = minus(b, a);
        const V3 edge_c = minus(c, a);
        const V3 normal = cross(edge_b, edge_c);
        const V3 q = cross(minus(origin, a), direction);
        const V scale = hn::Div(number(-1.0), dot(normal, direction));
        const V3 w = weights(q, edge_b, edge_c, scale, u, v);
        const V3 met = plus(origin, times(lanes_.of_ray(SurfaceRows::kT), direction));
        lanes_.store_position(blend(w, a, b, c),
                              larger(larger(largest(a), largest(b)), largest(c)));
        store_normals(normal, u, v);
        return double_bits(is_far(w, edge_b, edge_c, normal, met));
    }

private:
    using V = DoubleVector;
    using V3 = DoubleVector3;

    static HWY_INLINE V3 blend(const V3& weights, const V3& a, const V3& b, const V3& c) {
        return plus(plus(times(weights.x, a), times(weights.y, b)), times(weights.z, c));
    }

    HWY_INLINE V of_triangle(std::size_t row) const {
        const hn::Rebind<float, Doubles> f;
        return hn::PromoteTo(Doubles(), hn::LoadU(f, first_ + row * SurfaceRows::kLanes));
    }
    HWY_INLINE V3 of_triangle3(std::size_t first) const {
        return {of_triangle(first), of_triangle(first + 1), of_triangle(first + 2)};
    }

    // exact_weights of local_point.cpp.
    static HWY_INLINE V3 weights(const V3& q, const V3& edge_b, const V3& edge_c, V scale, V u,
                                 V v) {
        const V exact_u = hn::Mul(dot(q, edge_c), scale);
        const V exact_v = hn::Mul(hn::Neg(dot(q, edge_b)), scale);
        const V gap = number(1e-3);
        const auto near = hn::And(hn::Lt(hn::Abs(hn::Sub(exact_u, u)), gap),
                                  hn::Lt(hn::Abs(hn::Sub(exact_v, v)), gap));
        const V at_u = hn::IfThenElse(near, exact_u, u);
        const V at_v = hn::IfThenElse(near, exact_v, v);
        return {hn::Sub(hn::Sub(number(1.0), at_u), at_v), at_u, at_v};
    }

    // Rim::is_far of local_point.cpp.
    static HWY_INLINE hn::Mask<Doubles> is_far(const V3& w, const V3& edge_b, const V3& edge_c,
                                               const V3& normal, const V3& met) {
        const V rim = rim_at(largest(met));
        const V3 across = minus(edge_c, edge_b);
        const V longest =
            hn::Max(hn::Max(dot(edge_b, edge_b), dot(edge_c, edge_c)), dot(across, across));
        const V least = hn::Min(hn::Min(w.x, w.y), w.z);
        const V wanted = hn::Mul(hn::Mul(hn::Mul(number(1.0001), rim), rim), longest);
        const V have = hn::Mul(hn::Mul(least, least), dot(normal, normal));
        return hn::And(hn::Gt(least, number(0.0)), hn::Gt(have, wanted));
    }

    HWY_INLINE void store_normals(const V3& normal, V u, V v) const {
        using In = TriangleSurfaces;
        lanes_.store3(SurfaceRows::kGeometric, normalize(normal));
        const V3 smooth =
            blend({hn::Sub(hn::Sub(number(1.0), u), v), u, v}, of_triangle3(In::kNormals),
                  of_triangle3(In::kNormals + 3), of_triangle3(In::kNormals + 6));
        const auto is_smooth = hn::Gt(dot(smooth, smooth), number(1e-12));
        const auto turns = hn::Lt(dot(smooth, normal), number(0.0));
        const auto choose = [&](V of_smooth, V of_flat) HWY_ATTR {
            const V turned = hn::IfThenElse(turns, hn::Neg(of_smooth), of_smooth);
            return hn::IfThenElse(is_smooth, turned, of_flat);
        };
        lanes_.store3(SurfaceRows::kShading,
                      normalize({choose(smooth.x, normal.x), choose(smooth.y, normal.y),
                                 choose(smooth.z, normal.z)}));
    }

    SurfaceLanes lanes_;
    const float* first_;
};

std::uint32_t find_triangles(const TriangleSurfaces::Inputs& in, SurfaceRows& rows) {
    std::uint32_t far = 0;
    for (std::size_t i = 0; i < rows.count; i += hn::Lanes(Doubles()))
        far |= TriangleLanes(in, rows, i).find() << i;
    return far;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raypick {

HWY_EXPORT(find_triangles);

bool TriangleSurfaces::takes(const HitObject& at) {
    return std::holds_alternative<MeshInstance>(at.object.shape) &&
           at.object_from_world.is_identity();
}

std::uint32_t TriangleSurfaces::find(SurfaceRows& rows) const {
    const std::uint32_t far = HWY_DYNAMIC_DISPATCH(find_triangles)(in_, rows);
    return ~far & ((1u << rows.count) - 1u);
}

}  // namespace raypick

#endif  // HWY_ONCE
