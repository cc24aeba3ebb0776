// One ray through the objects of a scene. Included once for each instruction set.
#if defined(RAYPICK_SINGLE_RAY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_SINGLE_RAY_INL_H
#undef RAYPICK_SINGLE_RAY_INL_H
#else
#define RAYPICK_SINGLE_RAY_INL_H
#endif

#include "tracer/accel/joined_sets.h"
#include "tracer/accel/leaf_elements.h"
#include "tracer/accel/passage.h"
#include "tracer/accel/simd/cone_filter-inl.h"
#include "tracer/accel/simd/sphere_filter-inl.h"
#include "tracer/accel/simd/triangle_filter-inl.h"
#include "tracer/accel/simd/wide_traversal-inl.h"
#include "tracer/geometry/absolute.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

inline float largest_of(const glm::vec3& v) {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

// What lies behind a ray's origin is not on it.
inline Ray from_origin(Ray ray) {
    if (ray.t_min < 0.0f) ray.t_min = 0.0f;
    return ray;
}

// A ray in the space of a tree. `reach` is the largest coordinate of the origin and of whatever is
// searched.
class RayInSpace {
public:
    // As it came, for objects that stand where their shapes do.
    RayInSpace(const Ray& ray, float reach)
        : origin_reach_(largest_of(ray.origin)),
          slabs_(ray, kDoubleSlop * std::max(origin_reach_, reach)),
          filter_(ray.origin, ray.direction) {}

    RayInSpace(const ObjectRay& ray, const Instance& instance)
        : origin_reach_(largest_of(glm::vec3(ray.origin))),
          slabs_(slabs_of(glm::vec3(ray.origin), glm::vec3(ray.direction),
                          instance.slop * std::max(origin_reach_, instance.tree->reach))),
          sheared_(shear(ray)),
          filter_(*sheared_) {}

    [[nodiscard]] const SlabRay& slabs() const { return slabs_; }
    [[nodiscard]] const TriangleFilter& filter() const { return filter_; }
    [[nodiscard]] float reach(const PrimitiveTree& tree) const {
        return std::max(origin_reach_, tree.reach);
    }
    // `ray` is the same.
    const ShearedRay& sheared(const ObjectRay& ray) {
        if (!sheared_) sheared_ = shear(ray);
        return *sheared_;
    }

private:
    // Of a ray that float can't hold one that meets every box there is: infinity less infinity is
    // no number, which would let it into the empty boxes of children that aren't there, too.
    static SlabRay slabs_of(const glm::vec3& origin, const glm::vec3& direction, float slop) {
        const glm::vec3 sum = absolute(origin) + absolute(direction) + slop;
        if (std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z)) {
            return {origin, direction, slop};
        }
        return {glm::vec3(0.0f), glm::vec3(0.0f), std::numeric_limits<float>::max()};
    }

    float origin_reach_;
    SlabRay slabs_;
    std::optional<ShearedRay> sheared_;  // as soon as it is needed
    TriangleFilter filter_;
};

// Calls some(patch, triangles) for a leaf's patches in which the ray may hit triangles, until it
// returns true, and returns whether it did.
template <typename Search, typename Some>
bool each_filtered(const PrimitiveTree& tree, const WideRef& leaf, RayInSpace& space,
                   const Search& search, const Some& some) {
    const float reach = space.reach(tree);
    return each_patch(tree.patches, leaf, [&](const TrianglePatch& patch) HWY_ATTR {
        const std::uint32_t triangles = space.filter().may_hit(patch, reach, search.limit());
        return triangles != 0 && some(patch, triangles);
    });
}

// Told to searches before they are offered what stands in an object. Most learn it from the hit.
template <typename Search>
void set_object(Search& /*search*/, std::uint32_t /*object*/) {}

// A shape as rays meet it: itself, or a tree over primitives, of which `part` is to be searched.
template <typename Search>
struct ShapeTrace {
    const Passage& passage;
    RayInSpace* space;  // of trees
    WideRef part;
    Search& search;

    template <typename SimpleShape>
    bool operator()(const SimpleShape& shape) const {
        return offer(passage, raypick::intersect(shape, passage.local), std::nullopt, search);
    }

    bool operator()(const Rectangle& rectangle) const {
        return offer_rectangle(passage, rectangle, search);
    }

    bool operator()(const SphereSetInstance& instance) const {
        const SphereSet& set = passage.scene.sphere_sets[instance.set];
        const SphereFilter filter(passage.local, passage.ray.t_min,
                                  space->reach(*passage.instance.tree), !passage.instance.identity);
        return each_element(set, filter, [&](std::uint32_t primitive) HWY_ATTR {
            return offer_sphere(passage, sphere_of(set, primitive), primitive, search);
        });
    }

    bool operator()(const ConeSetInstance& instance) const {
        const ConeSet& set = passage.scene.cone_sets[instance.set];
        const ConeFilter filter(passage.local, passage.ray.t_min,
                                space->reach(*passage.instance.tree), !passage.instance.identity);
        return each_element(set, filter, [&](std::uint32_t primitive) HWY_ATTR {
            return offer_cone(passage, cone_of(set, primitive), primitive, search);
        });
    }

    bool operator()(const MeshInstance&) const {
        return each_leaf([&](const WideRef& leaf) HWY_ATTR { return triangles_of(leaf); });
    }

    // Of a leaf of a mesh.
    [[nodiscard]] bool triangles_of(const WideRef& leaf) const {
        return each_filtered(*passage.instance.tree, leaf, *space, search,
                             [this](const TrianglePatch& patch, std::uint32_t some)
                                 HWY_ATTR { return triangles(patch, some); });
    }

    // Of a patch those in the mask.
    [[nodiscard]] bool triangles(const TrianglePatch& patch, std::uint32_t some) const {
        for (; some != 0; some &= some - 1) {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(some));
            if (triangle(space->sheared(passage.local), patch.position(i, 0), patch.position(i, 1),
                         patch.position(i, 2), patch.primitives()[i])) {
                return true;
            }
        }
        return false;
    }

    // The one primitive of a mesh or a set, or the shape itself.
    [[nodiscard]] bool primitive(std::uint32_t number) const {
        const Scene& scene = passage.scene;
        const Shape& shape = passage.object.shape;
        if (const auto* mesh = std::get_if<MeshInstance>(&shape)) {
            const Mesh& of = scene.meshes[mesh->mesh];
            const glm::uvec3 corner = of.triangles[number];
            return triangle(shear(passage.local), of.positions[corner.x], of.positions[corner.y],
                            of.positions[corner.z], number);
        }
        if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
            const Sphere sphere = sphere_of(scene.sphere_sets[spheres->set], number);
            return offer_sphere(passage, sphere, number, search);
        }
        if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
            const Cone cone = cone_of(scene.cone_sets[cones->set], number);
            return offer_cone(passage, cone, number, search);
        }
        return std::visit(*this, shape);
    }

private:
    [[nodiscard]] bool triangle(const ShearedRay& ray, const glm::vec3& a, const glm::vec3& b,
                                const glm::vec3& c, std::uint32_t primitive) const {
        const auto found = intersect_triangle(ray, glm::dvec3(a), glm::dvec3(b), glm::dvec3(c));
        if (!found) return false;
        const auto t = static_cast<float>(found->t);
        if (!passage.in_range(t, search.limit())) return false;
        const Hit hit{passage.object.id, primitive, t, glm::vec2(found->u, found->v),
                      found->front_face};
        return passage.admits(hit) && search.offer(hit);
    }

    template <typename Leaf>
    [[nodiscard]] bool each_leaf(const Leaf& leaf) const {
        return walk(
            passage.instance.tree->bvh, part, space->slabs(), passage.ray.t_min,
            [this]() HWY_ATTR { return search.limit(); }, leaf);
    }

    // Calls offer(number) for the elements of a set that the filter lets through.
    template <typename Set, typename Filter, typename Offer>
    [[nodiscard]] bool each_element(const Set& set, const Filter& filter,
                                    const Offer& offer_one) const {
        const WideBvh& bvh = passage.instance.tree->bvh;
        return each_leaf([&](const WideRef& leaf) HWY_ATTR {
            const std::span<const std::uint32_t> primitives = indices_of(bvh, leaf);
            constexpr std::size_t kMost = Filter::kAtOnce;
            for (std::size_t i = 0; i < primitives.size(); i += kMost) {
                const auto some = primitives.subspan(i, std::min(kMost, primitives.size() - i));
                std::uint32_t left = filter.may_hit(elements_of(set, some), search.limit());
                for (; left != 0; left &= left - 1) {
                    const std::uint32_t index =
                        some[static_cast<std::size_t>(std::countr_zero(left))];
                    if (offer_one(index & ~WideBvh::kLast)) return true;
                }
            }
            return false;
        });
    }
};

// An object without a tree.
template <typename Search>
bool trace_simple(const AccelState& state, std::uint32_t index, const Ray& ray,
                  const RayQuery& query, Search& search) {
    const Object& object = state.scene->objects[index];
    if ((object.mask & query.mask) == 0) return false;
    const Instance& instance = state.instances[index];
    const Passage passage{*state.scene, object, instance, ray, query, object_ray(instance, ray)};
    return std::visit(ShapeTrace<Search>{passage, nullptr, {}, search}, object.shape);
}

// The elements of a leaf of joined sets that the filter lets through.
template <typename Filter, typename Search>
bool trace_joined_elements(const AccelState& state, const Instance& joined,
                           const JoinedElement* elements, const LeafElements& all,
                           const Filter& filter, const Ray& ray, const RayQuery& query,
                           Search& search) {
    for (std::size_t i = 0; i < all.size(); i += Filter::kAtOnce) {
        const LeafElements some{all.row(i), all.stride, std::min(Filter::kAtOnce, all.size() - i)};
        std::uint32_t left = filter.may_hit(some, search.limit());
        for (; left != 0; left &= left - 1) {
            const JoinedElement& element =
                elements[i + static_cast<std::size_t>(std::countr_zero(left))];
            const Member& member = joined.members[element.member];
            if (member.object == kNobody) continue;
            const Object& object = state.scene->objects[member.object];
            if ((object.mask & query.mask) == 0) continue;
            const Passage passage{*state.scene, object, *member.instance,
                                  ray,          query,  object_ray(*member.instance, ray)};
            set_object(search, member.object);
            if (ShapeTrace<Search>{passage, nullptr, {}, search}.primitive(element.primitive)) {
                return true;
            }
        }
    }
    return false;
}

// The joined tree of sets, or a part of it. `world` is the ray.
template <typename Search>
bool trace_joined_sets(const AccelState& state, const TopEntry& entry, const Ray& ray,
                       RayInSpace& world, const RayQuery& query, Search& search) {
    const Instance& joined = state.instances[entry.object];
    const PrimitiveTree& tree = *joined.tree;
    const std::size_t stride = tree.elements.stride;
    const ObjectRay local = object_ray(joined, ray);
    const float reach = world.reach(tree);
    const SphereFilter sphere_filter(local, ray.t_min, reach, false);
    const ConeFilter cone_filter(local, ray.t_min, reach, false);
    return walk(
        tree.bvh, entry.part, world.slabs(), ray.t_min, [&]() HWY_ATTR { return search.limit(); },
        [&](const WideRef& at) HWY_ATTR {
            const JoinedLeaf leaf = joined_leaf(tree.bvh, tree.elements, at);
            const LeafElements spheres{leaf.rows, stride, leaf.spheres};
            const LeafElements cones{spheres.row(leaf.spheres), stride, leaf.cones};
            return trace_joined_elements(state, joined, leaf.elements, spheres, sphere_filter, ray,
                                         query, search) ||
                   trace_joined_elements(state, joined, leaf.elements + leaf.spheres, cones,
                                         cone_filter, ray, query, search);
        });
}

// A leaf of the joined tree of meshes. `world` is the ray.
template <typename Search>
bool trace_joined_leaf(const AccelState& state, const Instance& joined, const WideRef& leaf,
                       const Ray& ray, RayInSpace& world, const RayQuery& query, Search& search) {
    return each_filtered(
        *joined.tree, leaf, world, search,
        [&](const TrianglePatch& patch, std::uint32_t some) HWY_ATTR {
            const Member& member = joined.members[patch.member];
            if (member.object == kNobody) return false;
            const Object& object = state.scene->objects[member.object];
            if ((object.mask & query.mask) == 0) return false;
            const Passage passage{*state.scene, object, *member.instance,
                                  ray,          query,  object_ray(*member.instance, ray)};
            set_object(search, member.object);
            return ShapeTrace<Search>{passage, &world, {}, search}.triangles(patch, some);
        });
}

// `world` is the ray.
template <typename Search>
bool trace_entry(const AccelState& state, const TopEntry& entry, const Ray& ray, RayInSpace& world,
                 const RayQuery& query, Search& search) {
    const Instance& instance = state.instances[entry.object];
    if (instance.tree == nullptr) return trace_simple(state, entry.object, ray, query, search);
    if (instance.joined() && !instance.tree->bvh.indices.empty()) {
        return trace_joined_sets(state, entry, ray, world, query, search);
    }
    if (instance.joined()) {
        return walk(
            instance.tree->bvh, entry.part, world.slabs(), ray.t_min,
            [&]() HWY_ATTR { return search.limit(); },
            [&](const WideRef& leaf) HWY_ATTR {
                return trace_joined_leaf(state, instance, leaf, ray, world, query, search);
            });
    }
    const Object& object = state.scene->objects[entry.object];
    if ((object.mask & query.mask) == 0) return false;
    const Passage passage{*state.scene, object, instance, ray, query, object_ray(instance, ray)};
    if (instance.identity) {
        return std::visit(ShapeTrace<Search>{passage, &world, entry.part, search}, object.shape);
    }
    RayInSpace local(passage.local, instance);
    return std::visit(ShapeTrace<Search>{passage, &local, entry.part, search}, object.shape);
}

template <typename Search>
bool trace_primitive(const AccelState& state, std::uint32_t object, std::uint32_t primitive,
                     const Ray& ray, const RayQuery& query, Search& search) {
    const Instance& instance = state.instances[object];
    const Passage passage{*state.scene, state.scene->objects[object], instance, ray,
                          query,        object_ray(instance, ray)};
    return ShapeTrace<Search>{passage, nullptr, {}, search}.primitive(primitive);
}

// Down the top tree, or a part of it.
template <typename Search>
bool trace_top(const AccelState& state, const WideRef& part, const Ray& ray, RayInSpace& world,
               const RayQuery& query, Search& search) {
    return walk(
        state.top, part, world.slabs(), ray.t_min, [&]() HWY_ATTR { return search.limit(); },
        [&](const WideRef& leaf) HWY_ATTR {
            return each_index(state.top, leaf, [&](std::uint32_t entry) HWY_ATTR {
                return trace_entry(state, state.entries[entry], ray, world, query, search);
            });
        });
}

template <typename Search>
void trace_ray(const AccelState& state, const Ray& ray, const RayQuery& query, Search& search) {
    if (!usable(ray)) return;
    for (const std::uint32_t object : state.unbounded) {
        if (trace_simple(state, object, ray, query, search)) return;
    }
    RayInSpace world(ray, state.reach);
    if (!state.top.empty()) trace_top(state, state.top.root, ray, world, query, search);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
