#include "tracer/accel/triangle_surfaces.h"

#include <limits>
#include <variant>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/triangle_surfaces.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "tracer/accel/simd/triples-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The steps are those of surface.cpp and local_point.cpp one by one, in double, so that no bit
// differs.
class TriangleKernel {
public:
    TriangleKernel(const TriangleSurfaces::Inputs& in, SurfaceRows& rows) : in_(in), rows_(rows) {}

    // Returns bits of those that lie far from the edges.
    HWY_INLINE std::uint32_t run() const {
        std::uint32_t far = 0;
        for (std::size_t i = 0; i < rows_.count; i += hn::Lanes(kDoubles))
            far |= step(i) << i;
        return far;
    }

private:
    using Doubles = hn::CappedTag<double, TriangleSurfaces::kLanes>;
    using Floats = hn::Rebind<float, Doubles>;
    using V = hn::Vec<Doubles>;
    static constexpr Doubles kDoubles{};
    static constexpr Floats kFloats{};

    using V3 = Triple<V>;

    static HWY_INLINE V number(double x) { return hn::Set(kDoubles, x); }
    static HWY_INLINE V3 unit(const V3& a) {
        return times(hn::Div(number(1.0), hn::Sqrt(dot(a, a))), a);
    }
    static HWY_INLINE V largest(const V3& a) {
        const V3 s = size(a);
        return hn::Max(hn::Max(s.x, s.y), s.z);
    }
    static HWY_INLINE V3 blend(const V3& weights, const V3& a, const V3& b, const V3& c) {
        return plus(plus(times(weights.x, a), times(weights.y, b)), times(weights.z, c));
    }

    static HWY_INLINE V load(const float* row, std::size_t i) {
        return hn::PromoteTo(kDoubles, hn::LoadU(kFloats, row + i));
    }
    HWY_INLINE V of_triangle(std::size_t row, std::size_t i) const {
        return load(&in_.row[row * SurfaceRows::kLanes], i);
    }
    HWY_INLINE V3 of_triangle3(std::size_t first, std::size_t i) const {
        return {of_triangle(first, i), of_triangle(first + 1, i), of_triangle(first + 2, i)};
    }
    HWY_INLINE V of_ray(std::size_t row, std::size_t i) const {
        return load(&rows_.row[row * SurfaceRows::kLanes], i);
    }
    HWY_INLINE V3 of_ray3(std::size_t first, std::size_t i) const {
        return {of_ray(first, i), of_ray(first + 1, i), of_ray(first + 2, i)};
    }
    HWY_INLINE void store(std::size_t first, std::size_t i, const V3& a, float more = -0.0f) const {
        const auto put = [&](std::size_t row, V v) HWY_ATTR {
            const auto rounded = hn::DemoteTo(kFloats, v);
            hn::StoreU(hn::Add(rounded, hn::Set(kFloats, more)), kFloats,
                       &rows_.row[row * SurfaceRows::kLanes + i]);
        };
        put(first, a.x);
        put(first + 1, a.y);
        put(first + 2, a.z);
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
        const V away = largest(met);
        const V rim = hn::Mul(
            number(64.0), hn::Add(hn::Mul(away, number(0x1p-24)), hn::Mul(away, number(0x1p-47))));
        const V3 across = minus(edge_c, edge_b);
        const V longest =
            hn::Max(hn::Max(dot(edge_b, edge_b), dot(edge_c, edge_c)), dot(across, across));
        const V least = hn::Min(hn::Min(w.x, w.y), w.z);
        const V wanted = hn::Mul(hn::Mul(hn::Mul(number(1.0001), rim), rim), longest);
        const V have = hn::Mul(hn::Mul(least, least), dot(normal, normal));
        return hn::And(hn::Gt(least, number(0.0)), hn::Gt(have, wanted));
    }

    HWY_INLINE void store_normals(std::size_t i, const V3& normal, V u, V v) const {
        using In = TriangleSurfaces;
        store(SurfaceRows::kGeometric, i, unit(normal));
        const V3 smooth =
            blend({hn::Sub(hn::Sub(number(1.0), u), v), u, v}, of_triangle3(In::kNormals, i),
                  of_triangle3(In::kNormals + 3, i), of_triangle3(In::kNormals + 6, i));
        const auto is_smooth = hn::Gt(dot(smooth, smooth), number(1e-12));
        const auto turns = hn::Lt(dot(smooth, normal), number(0.0));
        const auto choose = [&](V of_smooth, V of_flat) HWY_ATTR {
            const V turned = hn::IfThenElse(turns, hn::Neg(of_smooth), of_smooth);
            return hn::IfThenElse(is_smooth, turned, of_flat);
        };
        store(SurfaceRows::kShading, i,
              unit({choose(smooth.x, normal.x), choose(smooth.y, normal.y),
                    choose(smooth.z, normal.z)}));
    }

    HWY_INLINE std::uint32_t step(std::size_t i) const {
        using In = TriangleSurfaces;
        const V3 a = of_triangle3(In::kCorners, i);
        const V3 b = of_triangle3(In::kCorners + 3, i);
        const V3 c = of_triangle3(In::kCorners + 6, i);
        const V3 origin = of_ray3(SurfaceRows::kOrigin, i);
        const V3 direction = of_ray3(SurfaceRows::kDirection, i);
        const V u = of_triangle(In::kU, i);
        const V v = of_triangle(In::kV, i);
        const V3 edge_b = minus(b, a);
        const V3 edge_c = minus(c, a);
        const V3 normal = cross(edge_b, edge_c);
        const V3 q = cross(minus(origin, a), direction);
        const V scale = hn::Div(number(-1.0), dot(normal, direction));
        const V3 w = weights(q, edge_b, edge_c, scale, u, v);
        const V3 met = plus(origin, times(of_ray(SurfaceRows::kT, i), direction));

        const V3 position = blend(w, a, b, c);
        const V magnitude = hn::Max(hn::Max(largest(a), largest(b)), largest(c));
        const V3 reach = size(position);
        const auto bound = [&](V along) HWY_ATTR {
            return hn::Add(hn::Mul(along, number(0x1p-24)),
                           hn::Mul(hn::Add(along, magnitude), number(0x1p-47)));
        };
        store(SurfaceRows::kPosition, i, position);
        store(SurfaceRows::kError, i, {bound(reach.x), bound(reach.y), bound(reach.z)},
              std::numeric_limits<float>::min());
        store_normals(i, normal, u, v);
        return bits(is_far(w, edge_b, edge_c, normal, met));
    }

    static HWY_INLINE std::uint32_t bits(hn::Mask<Doubles> mask) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(kDoubles, mask, bytes);
        return bytes[0];
    }

    const TriangleSurfaces::Inputs& in_;
    SurfaceRows& rows_;
};

std::uint32_t find_triangles(const TriangleSurfaces::Inputs& in, SurfaceRows& rows) {
    return TriangleKernel(in, rows).run();
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

void TriangleSurfaces::add(std::size_t lane, const Mesh& mesh, const Hit& hit) {
    float* const in = &in_.row[lane];
    const glm::uvec3& corner = mesh.triangles[hit.primitive];
    const bool smooth = !mesh.normals.empty();
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = corner[static_cast<int>(k)];
        put_vector<kLanes>(in, kCorners + 3 * k, mesh.positions[vertex]);
        put_vector<kLanes>(in, kNormals + 3 * k, smooth ? mesh.normals[vertex] : glm::vec3(0.0f));
    }
    in[kU * kLanes] = hit.uv.x;
    in[kV * kLanes] = hit.uv.y;
}

std::uint32_t TriangleSurfaces::find(SurfaceRows& rows) const {
    const std::uint32_t far = HWY_DYNAMIC_DISPATCH(find_triangles)(in_, rows);
    return ~far & ((1u << rows.count) - 1u);
}

}  // namespace raypick

#endif  // HWY_ONCE
