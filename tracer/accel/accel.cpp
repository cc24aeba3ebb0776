#include "tracer/accel/accel.h"

#include "tracer/accel/bvh.h"
#include "tracer/accel/cut_out.h"
#include "tracer/accel/searches.h"
#include "tracer/accel/trees.h"
#include "tracer/geometry/triangle_test.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <variant>

namespace raypick {

namespace {

// An object as rays meet it.
struct Instance {
    Transform object_from_world;
    bool identity = true;
    bool holes = false;  // it may be cut out
    float slop = 0.0f;   // how far rounding may have moved a ray in object space, per unit
    const PrimitiveTree* tree = nullptr;
};

bool inside_clip_planes(const Ray& ray, float t, std::span<const ClipPlane> planes) {
    return std::all_of(planes.begin(), planes.end(), [&](const ClipPlane& plane) {
        return glm::dot(plane.normal, ray.at(t)) + plane.d >= 0.0f;
    });
}

bool shows(Sides sides, bool front_face) {
    if (sides == Sides::both) return true;
    return front_face == (sides == Sides::front_only);
}

// One ray on its way through one object.
struct Passage {
    const Scene& scene;
    const Object& object;
    const Instance& instance;
    const Ray& ray;
    const RayQuery& query;
    ObjectRay local;

    [[nodiscard]] bool admits(const Hit& hit) const {
        if (!shows(object.sides, hit.front_face) || !shows(query.sides, hit.front_face)) {
            return false;
        }
        if (!inside_clip_planes(ray, hit.t, query.clip_planes)) return false;
        if (instance.holes && is_cut_out(scene, object, hit)) return false;
        return query.accept(hit);
    }
    [[nodiscard]] bool in_range(float t, float limit) const {
        return t > ray.t_min && t < ray.t_max && t <= limit;
    }
};

// Offers to the search what a shape's intersection found; true: stop. `element` is the shape's
// number in a set: that is then the primitive, whatever side of the shape was hit.
template <typename Search>
bool offer(const Passage& passage, const ShapeHits& hits, std::optional<std::uint32_t> element,
           Search& search) {
    for (int i = 0; i < hits.count; ++i) {
        const ShapeHit& found = hits.hit[static_cast<std::size_t>(i)];
        const auto t = static_cast<float>(found.t);
        if (!passage.in_range(t, search.limit())) continue;
        const Hit hit{passage.object.id, element.value_or(found.primitive), t, glm::vec2(found.uv),
                      glm::dot(found.normal, passage.local.direction) < 0.0};
        if (passage.admits(hit) && search.offer(hit)) return true;
    }
    return false;
}

ObjectRay object_ray(const Instance& instance, const Ray& ray) {
    if (instance.identity) return {glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
    return {instance.object_from_world.point(glm::dvec3(ray.origin)),
            instance.object_from_world.vector(glm::dvec3(ray.direction))};
}

// What has a tree knows its box already.
Bounds instance_bounds(const Scene& scene, const Object& object, const PrimitiveTree* tree) {
    if (tree == nullptr) return object_bounds(scene, object);
    if (tree->bvh.nodes.empty()) return {};
    const Bounds& box = tree->bvh.nodes[0].bounds;
    return world_bounds(object.world_from_object, glm::dvec3(box.min), glm::dvec3(box.max));
}

bool usable(const Ray& ray) {
    const glm::vec3 sum = ray.origin + ray.direction;
    const bool finite = std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
    return finite && ray.direction != glm::vec3(0.0f) && ray.t_min < ray.t_max;
}

}  // namespace

struct Accel::State {
    std::shared_ptr<const Scene> scene;
    SceneTrees trees;
    std::vector<Instance> instances;       // one an object
    Bvh top;                               // over the finite objects
    std::vector<std::uint32_t> unbounded;  // infinite planes
    Bounds bounds;

    void place_objects(const BuildOptions& options);

    template <typename Search>
    bool trace_object(std::uint32_t index, const Ray& ray, const RayQuery& query,
                      Search& search) const;
    template <typename Search>
    void trace(const Ray& ray, const RayQuery& query, Search& search) const;
};

void Accel::State::place_objects(const BuildOptions& options) {
    std::vector<Bounds> boxes;
    boxes.reserve(scene->objects.size());
    instances.reserve(scene->objects.size());
    for (const Object& object : scene->objects) {
        Instance instance;
        instance.identity = object.world_from_object.is_identity();
        instance.object_from_world = inverse(object.world_from_object).value_or(Transform{});
        instance.holes = may_be_cut_out(*scene, object);
        instance.tree = tree_of(trees, object.shape);
        // Rounding a transformed ray to float moves it by half a unit in the last place of its
        // coordinates; the boxes are widened by several times that.
        if (!instance.identity) instance.slop = 8.0f * 5.9604645e-8f;
        instances.push_back(instance);
        boxes.push_back(instance_bounds(*scene, object, instance.tree));
        if (!boxes.back().empty()) {
            bounds.extend(boxes.back());
        } else if (std::holds_alternative<Plane>(object.shape)) {
            unbounded.push_back(static_cast<std::uint32_t>(instances.size() - 1));
        }
    }
    top = build_bvh(boxes, options.threads, options.stop);
}

// A shape as rays meet it: itself, or a tree over primitives.
template <typename Search>
struct ShapeTrace {
    const Passage& passage;
    Search& search;

    template <typename SimpleShape>
    bool operator()(const SimpleShape& shape) const {
        return offer(passage, raypick::intersect(shape, passage.local), std::nullopt, search);
    }

    bool operator()(const SphereSetInstance& instance) const {
        const SphereSet& set = passage.scene.sphere_sets[instance.set];
        return down_the_tree([&](std::uint32_t primitive) {
            const Sphere sphere = sphere_of(set, primitive);
            return offer(passage, raypick::intersect(sphere, passage.local), primitive, search);
        });
    }

    bool operator()(const ConeSetInstance& instance) const {
        const ConeSet& set = passage.scene.cone_sets[instance.set];
        return down_the_tree([&](std::uint32_t primitive) {
            const Cone cone = cone_of(set, primitive);
            return offer(passage, raypick::intersect(cone, passage.local), primitive, search);
        });
    }

    bool operator()(const MeshInstance& instance) const {
        const Mesh& mesh = passage.scene.meshes[instance.mesh];
        const ShearedRay sheared = shear(passage.local);
        return down_the_tree([&](std::uint32_t primitive) {
            const glm::uvec3 corner = mesh.triangles[primitive];
            const auto found = intersect_triangle(sheared, glm::dvec3(mesh.positions[corner.x]),
                                                  glm::dvec3(mesh.positions[corner.y]),
                                                  glm::dvec3(mesh.positions[corner.z]));
            if (!found) return false;
            const auto t = static_cast<float>(found->t);
            if (!passage.in_range(t, search.limit())) return false;
            const Hit hit{passage.object.id, primitive, t, glm::vec2(found->u, found->v),
                          found->front_face};
            return passage.admits(hit) && search.offer(hit);
        });
    }

private:
    template <typename Leaf>
    [[nodiscard]] bool down_the_tree(const Leaf& leaf) const {
        const Bvh& bvh = passage.instance.tree->bvh;
        if (bvh.nodes.empty()) return false;
        const glm::vec3 origin(passage.local.origin);
        const Bounds& box = bvh.nodes[0].bounds;
        const glm::vec3 reach =
            glm::max(glm::abs(origin), glm::max(glm::abs(box.min), glm::abs(box.max)));
        const SlabRay slabs(origin, glm::vec3(passage.local.direction),
                            passage.instance.slop * std::max({reach.x, reach.y, reach.z}));
        return traverse(
            bvh, slabs, passage.ray.t_min, [this] { return search.limit(); }, leaf);
    }
};

template <typename Search>
bool Accel::State::trace_object(std::uint32_t index, const Ray& ray, const RayQuery& query,
                                Search& search) const {
    const Object& object = scene->objects[index];
    if ((object.mask & query.mask) == 0) return false;
    const Instance& instance = instances[index];
    const Passage passage{*scene, object, instance, ray, query, object_ray(instance, ray)};
    return std::visit(ShapeTrace<Search>{passage, search}, object.shape);
}

template <typename Search>
void Accel::State::trace(const Ray& ray, const RayQuery& query, Search& search) const {
    if (!usable(ray)) return;
    for (const std::uint32_t index : unbounded) {
        if (trace_object(index, ray, query, search)) return;
    }
    const SlabRay slabs(ray.origin, ray.direction, 0.0f);
    traverse(
        top, slabs, ray.t_min, [&] { return search.limit(); },
        [&](std::uint32_t index) { return trace_object(index, ray, query, search); });
}

Accel::Accel(std::shared_ptr<const Scene> scene, const BuildOptions& options, const Accel* reuse) {
    check_scene(*scene);
    auto state = std::make_unique<State>();
    state->scene = std::move(scene);
    state->trees =
        build_trees(*state->scene, options, reuse != nullptr ? &reuse->state_->trees : nullptr);
    state->place_objects(options);
    state_ = std::move(state);
}

Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;

std::optional<Hit> Accel::intersect(const Ray& ray, const RayQuery& query) const {
    ClosestSearch closest(ray.t_max);
    state_->trace(ray, query, closest);
    if (!closest.winner().valid()) return std::nullopt;
    if (!closest.ambiguous()) return closest.winner();
    LowestInWindow lowest(closest.limit());
    state_->trace(ray, query, lowest);
    return lowest.winner();
}

bool Accel::occluded(const Ray& ray, const RayQuery& query) const {
    AnySearch any(ray.t_max);
    state_->trace(ray, query, any);
    return any.found();
}

std::vector<Hit> Accel::intersect_all(const Ray& ray, const RayQuery& query) const {
    AllSearch all(ray.t_max);
    state_->trace(ray, query, all);
    return std::move(all).sorted();
}

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits, const RayQuery& query) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[i] = intersect(rays[i], query).value_or(Hit{});
    }
}

void Accel::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                     const RayQuery& query) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        blocked[i] = occluded(rays[i], query) ? 1 : 0;
    }
}

const Scene& Accel::scene() const {
    return *state_->scene;
}
std::shared_ptr<const Scene> Accel::shared_scene() const {
    return state_->scene;
}
const Bounds& Accel::bounds() const {
    return state_->bounds;
}

AccelStats Accel::stats() const {
    AccelStats stats;
    stats.bytes = state_->top.bytes() + state_->instances.size() * sizeof(Instance);
    stats.nodes = state_->top.nodes.size();
    const auto count = [&stats](const TreeList& trees, std::uint64_t& primitives) {
        for (const auto& tree : trees) {
            primitives += tree->count;
            stats.nodes += tree->bvh.nodes.size();
            stats.bytes += tree->bvh.bytes();
        }
    };
    count(state_->trees.meshes, stats.triangles);
    count(state_->trees.sphere_sets, stats.spheres);
    count(state_->trees.cone_sets, stats.cones);
    return stats;
}

}  // namespace raypick
