#include "tracer/accel/triangle_surfaces.h"

#include "tracer/accel/lane_rows.h"
#include "tracer/accel/local_point.h"

#include <algorithm>
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
    explicit TriangleKernel(TriangleSurfaces::Block& block) : block_(block) {}

    HWY_INLINE void run(std::size_t count) const {
        for (std::size_t i = 0; i < count; i += hn::Lanes(kDoubles))
            step(i);
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

    HWY_INLINE V load(std::size_t row, std::size_t i) const {
        return hn::PromoteTo(kDoubles,
                             hn::LoadU(kFloats, &block_.in[row * TriangleSurfaces::kLanes + i]));
    }
    HWY_INLINE V3 load3(std::size_t first, std::size_t i) const {
        return {load(first, i), load(first + 1, i), load(first + 2, i)};
    }
    HWY_INLINE void store(std::size_t first, std::size_t i, const V3& a, float more = 0.0f) const {
        const auto put = [&](std::size_t row, V v) HWY_ATTR {
            const auto rounded = hn::DemoteTo(kFloats, v);
            hn::StoreU(hn::Add(rounded, hn::Set(kFloats, more)), kFloats,
                       &block_.out[row * TriangleSurfaces::kLanes + i]);
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

    // How far beyond the rim the point lies: Rim::is_far of local_point.cpp.
    static HWY_INLINE V room(const V3& w, const V3& edge_b, const V3& edge_c, const V3& normal,
                             const V3& met) {
        const V away = largest(met);
        const V rim = hn::Mul(
            number(64.0), hn::Add(hn::Mul(away, number(0x1p-24)), hn::Mul(away, number(0x1p-47))));
        const V3 across = minus(edge_c, edge_b);
        const V longest =
            hn::Max(hn::Max(dot(edge_b, edge_b), dot(edge_c, edge_c)), dot(across, across));
        const V least = hn::Min(hn::Min(w.x, w.y), w.z);
        const V wanted = hn::Mul(hn::Mul(hn::Mul(number(1.0001), rim), rim), longest);
        const V have = hn::Mul(hn::Mul(least, least), dot(normal, normal));
        return hn::IfThenElseZero(hn::Gt(least, number(0.0)), hn::Sub(have, wanted));
    }

    HWY_INLINE void store_normals(std::size_t i, const V3& normal, V u, V v) const {
        using In = TriangleSurfaces;
        store(In::kGeometric, i, unit(normal));
        const V3 smooth = blend({hn::Sub(hn::Sub(number(1.0), u), v), u, v}, load3(In::kNormals, i),
                                load3(In::kNormals + 3, i), load3(In::kNormals + 6, i));
        const auto is_smooth = hn::Gt(dot(smooth, smooth), number(1e-12));
        const auto turns = hn::Lt(dot(smooth, normal), number(0.0));
        const auto choose = [&](V of_smooth, V of_flat) HWY_ATTR {
            const V turned = hn::IfThenElse(turns, hn::Neg(of_smooth), of_smooth);
            return hn::IfThenElse(is_smooth, turned, of_flat);
        };
        store(In::kShading, i,
              unit({choose(smooth.x, normal.x), choose(smooth.y, normal.y),
                    choose(smooth.z, normal.z)}));
    }

    HWY_INLINE void step(std::size_t i) const {
        using In = TriangleSurfaces;
        const V3 a = load3(In::kCorners, i);
        const V3 b = load3(In::kCorners + 3, i);
        const V3 c = load3(In::kCorners + 6, i);
        const V3 origin = load3(In::kOrigin, i);
        const V3 direction = load3(In::kDirection, i);
        const V u = load(In::kU, i);
        const V v = load(In::kV, i);
        const V3 edge_b = minus(b, a);
        const V3 edge_c = minus(c, a);
        const V3 normal = cross(edge_b, edge_c);
        const V3 q = cross(minus(origin, a), direction);
        const V scale = hn::Div(number(-1.0), dot(normal, direction));
        const V3 w = weights(q, edge_b, edge_c, scale, u, v);
        const V3 met = plus(origin, times(load(In::kT, i), direction));
        hn::StoreU(room(w, edge_b, edge_c, normal, met), kDoubles, block_.room.data() + i);

        const V3 position = blend(w, a, b, c);
        const V magnitude = hn::Max(hn::Max(largest(a), largest(b)), largest(c));
        const V3 reach = size(position);
        const auto bound = [&](V along) HWY_ATTR {
            return hn::Add(hn::Mul(along, number(0x1p-24)),
                           hn::Mul(hn::Add(along, magnitude), number(0x1p-47)));
        };
        store(In::kPosition, i, position);
        store(In::kError, i, {bound(reach.x), bound(reach.y), bound(reach.z)},
              std::numeric_limits<float>::min());
        store_normals(i, normal, u, v);
    }

    TriangleSurfaces::Block& block_;
};

void find_triangles(std::span<TriangleSurfaces::Block> blocks, std::size_t count) {
    constexpr std::size_t kLanes = TriangleSurfaces::kLanes;
    for (std::size_t first = 0; first < count; first += kLanes)
        TriangleKernel(blocks[first / kLanes]).run(std::min(kLanes, count - first));
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

void TriangleSurfaces::add(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
                           SurfacePoint& result) {
    if (count_ == wanted_.size()) {
        blocks_.resize(2 * blocks_.size() + 1);
        wanted_.resize(kLanes * blocks_.size());
    }
    float* const in = &blocks_[count_ / kLanes].in[count_ % kLanes];
    const auto put = [in](std::size_t row, const glm::vec3& v) { put_vector<kLanes>(in, row, v); };
    const Mesh& mesh = scene.meshes[std::get<MeshInstance>(at.object.shape).mesh];
    const glm::uvec3& corner = mesh.triangles[hit.primitive];
    const bool smooth = !mesh.normals.empty();
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = corner[static_cast<int>(k)];
        put(kCorners + 3 * k, mesh.positions[vertex]);
        put(kNormals + 3 * k, smooth ? mesh.normals[vertex] : glm::vec3(0.0f));
    }
    put(kOrigin, ray.origin);
    put(kDirection, ray.direction);
    in[kT * kLanes] = hit.t;
    in[kU * kLanes] = hit.uv.x;
    in[kV * kLanes] = hit.uv.y;
    Wanted& wanted = wanted_[count_++];
    wanted.object = &at.object;
    wanted.object_from_world = &at.object_from_world;
    wanted.material = at.material;
    wanted.textured = at.textured;
    wanted.ray = &ray;
    wanted.hit = &hit;
    wanted.result = &result;
}

void TriangleSurfaces::find(const Scene& scene) {
    HWY_DYNAMIC_DISPATCH(find_triangles)(blocks_, count_);
    for (std::size_t i = 0; i < count_; ++i) {
        const Wanted& wanted = wanted_[i];
        const Block& block = blocks_[i / kLanes];
        if (block.room[i % kLanes] > 0.0) {
            take(wanted, block, i % kLanes);
            if (wanted.textured) take_uv(scene, wanted, i == 0 ? nullptr : &wanted_[i - 1]);
        } else {
            const HitObject at{*wanted.object, *wanted.object_from_world, wanted.material,
                               wanted.textured};
            set_surface_point(scene, at, *wanted.ray, *wanted.hit, *wanted.result);
        }
    }
}

void TriangleSurfaces::take(const Wanted& wanted, const Block& block, std::size_t lane) {
    const float* const out = &block.out[lane];
    SurfacePoint& surface = *wanted.result;
    surface.position = vector_at<kLanes>(out, kPosition);
    surface.position_error = vector_at<kLanes>(out, kError);
    surface.geometric_normal = vector_at<kLanes>(out, kGeometric);
    surface.shading_normal = vector_at<kLanes>(out, kShading);
    set_untextured(*wanted.hit, wanted.material, surface);
}

void TriangleSurfaces::take_uv(const Scene& scene, const Wanted& wanted, const Wanted* before) {
    SurfacePoint& surface = *wanted.result;
    surface.texture_uv = texture_uv(scene, *wanted.object, *wanted.hit);
    const std::uint32_t primitive = wanted.hit->primitive;
    if (before != nullptr && before->textured && before->object == wanted.object &&
        before->hit->primitive == primitive) {
        surface.dpdu = before->result->dpdu;
        surface.dpdv = before->result->dpdv;
        return;
    }
    const Mesh& mesh = scene.meshes[std::get<MeshInstance>(wanted.object->shape).mesh];
    const MeshDerivatives by_uv = mesh_derivatives(mesh, mesh.triangles[primitive]);
    surface.dpdu = glm::vec3(by_uv.dpdu);
    surface.dpdv = glm::vec3(by_uv.dpdv);
}

}  // namespace raypick

#endif  // HWY_ONCE
