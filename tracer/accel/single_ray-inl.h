// One ray through the objects of a scene. Included once for each instruction set.
#if defined(RAYPICK_SINGLE_RAY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_SINGLE_RAY_INL_H
#undef RAYPICK_SINGLE_RAY_INL_H
#else
#define RAYPICK_SINGLE_RAY_INL_H
#endif

#include "tracer/accel/passage.h"
#include "tracer/accel/triangle_filter-inl.h"
#include "tracer/accel/wide_traversal-inl.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// The largest coordinate of a ray's origin and of a tree.
inline float reach_of(const ObjectRay& ray, const Bounds& box) {
    const glm::vec3 reach =
        glm::max(glm::abs(glm::vec3(ray.origin)), glm::max(glm::abs(box.min), glm::abs(box.max)));
    return std::max({reach.x, reach.y, reach.z});
}

// A shape as rays meet it: itself, or a tree over primitives, of which `part` is to be searched.
template <typename Search>
struct ShapeTrace {
    const Passage& passage;
    WideRef part;
    Search& search;

    template <typename SimpleShape>
    bool operator()(const SimpleShape& shape) const {
        return offer(passage, raypick::intersect(shape, passage.local), std::nullopt, search);
    }

    bool operator()(const SphereSetInstance& instance) const {
        const SphereSet& set = passage.scene.sphere_sets[instance.set];
        return each_primitive([&](std::uint32_t primitive) HWY_ATTR {
            return offer_sphere(passage, sphere_of(set, primitive), primitive, search);
        });
    }

    bool operator()(const ConeSetInstance& instance) const {
        const ConeSet& set = passage.scene.cone_sets[instance.set];
        return each_primitive([&](std::uint32_t primitive) HWY_ATTR {
            return offer(passage, hits_in_range(passage, cone_of(set, primitive), search),
                         primitive, search);
        });
    }

    bool operator()(const MeshInstance& instance) const {
        const Mesh& mesh = passage.scene.meshes[instance.mesh];
        const WideBvh& bvh = passage.instance.tree->bvh;
        const ShearedRay sheared = shear(passage.local);
        const TriangleFilter filter(sheared, reach_of(passage.local, bvh.bounds));
        return each_leaf([&](const WideRef& leaf) HWY_ATTR {
            const auto at_once = static_cast<std::uint32_t>(hn::Lanes(Four()));
            for (std::uint32_t i = 0; i < leaf.count; i += at_once) {
                const std::uint32_t* primitives = bvh.indices.data() + leaf.first + i;
                std::uint32_t left = filter.may_hit(
                    mesh, primitives, std::min(at_once, leaf.count - i), search.limit());
                for (; left != 0; left &= left - 1) {
                    if (triangle(mesh, sheared, primitives[std::countr_zero(left)])) return true;
                }
            }
            return false;
        });
    }

    // The one primitive of a mesh or a set, or the shape itself.
    [[nodiscard]] bool primitive(std::uint32_t number) const {
        const Scene& scene = passage.scene;
        const Shape& shape = passage.object.shape;
        if (const auto* mesh = std::get_if<MeshInstance>(&shape)) {
            return triangle(scene.meshes[mesh->mesh], shear(passage.local), number);
        }
        if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
            const Sphere sphere = sphere_of(scene.sphere_sets[spheres->set], number);
            return offer_sphere(passage, sphere, number, search);
        }
        if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
            const Cone cone = cone_of(scene.cone_sets[cones->set], number);
            return offer(passage, raypick::intersect(cone, passage.local), number, search);
        }
        return std::visit(*this, shape);
    }

private:
    [[nodiscard]] bool triangle(const Mesh& mesh, const ShearedRay& ray,
                                std::uint32_t primitive) const {
        const glm::uvec3 corner = mesh.triangles[primitive];
        const auto found = intersect_triangle(ray, glm::dvec3(mesh.positions[corner.x]),
                                              glm::dvec3(mesh.positions[corner.y]),
                                              glm::dvec3(mesh.positions[corner.z]));
        if (!found) return false;
        const auto t = static_cast<float>(found->t);
        if (!passage.in_range(t, search.limit())) return false;
        const Hit hit{passage.object.id, primitive, t, glm::vec2(found->u, found->v),
                      found->front_face};
        return passage.admits(hit) && search.offer(hit);
    }

    template <typename Leaf>
    [[nodiscard]] bool each_leaf(const Leaf& leaf) const {
        const WideBvh& bvh = passage.instance.tree->bvh;
        const glm::vec3 origin(passage.local.origin);
        const SlabRay slabs(
            origin, glm::vec3(passage.local.direction),
            std::max(passage.instance.slop, kDoubleSlop) * reach_of(passage.local, bvh.bounds));
        return walk(
            bvh, part, slabs, passage.ray.t_min, [this]() HWY_ATTR { return search.limit(); },
            leaf);
    }

    template <typename Primitive>
    [[nodiscard]] bool each_primitive(const Primitive& primitive) const {
        const std::vector<std::uint32_t>& indices = passage.instance.tree->bvh.indices;
        return each_leaf([&](const WideRef& leaf) HWY_ATTR {
            for (std::uint32_t i = 0; i < leaf.count; ++i) {
                if (primitive(indices[leaf.first + i])) return true;
            }
            return false;
        });
    }
};

template <typename Search>
bool trace_entry(const AccelState& state, const TopEntry& entry, const Ray& ray,
                 const RayQuery& query, Search& search) {
    const Object& object = state.scene->objects[entry.object];
    if ((object.mask & query.mask) == 0) return false;
    const Instance& instance = state.instances[entry.object];
    const Passage passage{*state.scene, object, instance, ray, query, object_ray(instance, ray)};
    return std::visit(ShapeTrace<Search>{passage, entry.part, search}, object.shape);
}

template <typename Search>
bool trace_primitive(const AccelState& state, std::uint32_t object, std::uint32_t primitive,
                     const Ray& ray, const RayQuery& query, Search& search) {
    const Instance& instance = state.instances[object];
    const Passage passage{*state.scene, state.scene->objects[object], instance, ray,
                          query,        object_ray(instance, ray)};
    return ShapeTrace<Search>{passage, {}, search}.primitive(primitive);
}

// By how much the top tree's boxes are widened for a ray.
inline float top_slop(const Ray& ray) {
    return kDoubleSlop *
           std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)});
}

// Down the top tree, or a part of it.
template <typename Search>
bool trace_top(const AccelState& state, const WideRef& part, const Ray& ray, const RayQuery& query,
               Search& search) {
    const SlabRay slabs(ray.origin, ray.direction, top_slop(ray));
    return walk(
        state.top, part, slabs, ray.t_min, [&]() HWY_ATTR { return search.limit(); },
        [&](const WideRef& leaf) HWY_ATTR {
            for (std::uint32_t i = 0; i < leaf.count; ++i) {
                const TopEntry& entry = state.entries[state.top.indices[leaf.first + i]];
                if (trace_entry(state, entry, ray, query, search)) return true;
            }
            return false;
        });
}

template <typename Search>
void trace_ray(const AccelState& state, const Ray& ray, const RayQuery& query, Search& search) {
    if (!usable(ray)) return;
    for (const std::uint32_t object : state.unbounded) {
        if (trace_entry(state, {object, {}}, ray, query, search)) return;
    }
    if (!state.top.empty()) trace_top(state, state.top.root, ray, query, search);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
