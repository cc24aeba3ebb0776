#include "tracer/accel/accel.h"

#include "tracer/accel/bvh.h"
#include "tracer/error.h"
#include "tracer/geometry/triangle_test.h"
#include "tracer/parallel/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace raypick {

namespace {

// One mesh's tree, shared by every Accel that uses the same arrays.
struct MeshTree {
    const glm::vec3* positions = nullptr;
    const glm::uvec3* triangles = nullptr;
    std::size_t triangle_count = 0;
    Bvh bvh;
};

// An object as rays meet it.
struct Instance {
    Transform object_from_world;
    bool identity = true;
    float slop = 0.0f;  // how far rounding may have moved a ray in object space, per unit
    const MeshTree* tree = nullptr;
};

MeshTree build_tree(const Mesh& mesh, const BuildOptions& options) {
    constexpr std::size_t kChunk = 1u << 16;
    MeshTree tree;
    tree.positions = mesh.positions.data();
    tree.triangles = mesh.triangles.data();
    tree.triangle_count = mesh.triangles.size();
    std::vector<Bounds> boxes(mesh.triangles.size());
    parallel_for((boxes.size() + kChunk - 1) / kChunk, options.threads, options.stop,
                 [&](std::size_t chunk) {
                     const std::size_t end = std::min(boxes.size(), (chunk + 1) * kChunk);
                     for (std::size_t i = chunk * kChunk; i < end; ++i) {
                         const glm::uvec3 t = mesh.triangles[i];
                         const glm::vec3 sum =
                             mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z];
                         // A triangle with a NaN is never hit: its box stays empty.
                         if (!std::isfinite(sum.x + sum.y + sum.z)) continue;
                         for (int k = 0; k < 3; ++k)
                             boxes[i].extend(mesh.positions[t[k]]);
                     }
                 });
    if (options.stop.stop_requested()) throw Cancelled();
    tree.bvh = build_bvh(boxes, options.threads, options.stop);
    return tree;
}

bool same_arrays(const MeshTree& tree, const Mesh& mesh) {
    return tree.positions == mesh.positions.data() && tree.triangles == mesh.triangles.data() &&
           tree.triangle_count == mesh.triangles.size();
}

bool inside_clip_planes(const Ray& ray, float t, std::span<const ClipPlane> planes) {
    return std::all_of(planes.begin(), planes.end(), [&](const ClipPlane& plane) {
        return glm::dot(plane.normal, ray.at(t)) + plane.d >= 0.0f;
    });
}

bool admitted(const Ray& ray, const RayQuery& query, const Hit& hit) {
    if (query.sides == Sides::front_only && !hit.front_face) return false;
    if (query.sides == Sides::back_only && hit.front_face) return false;
    return inside_clip_planes(ray, hit.t, query.clip_planes) && query.accept(hit);
}

float tie_limit(float t) {
    return static_cast<float>(t * (1.0 + kTieGap));
}

bool precedes(const Hit& a, const Hit& b) {
    return std::tie(a.object, a.primitive) < std::tie(b.object, b.primitive);
}

// The searches that a traversal drives: limit() is how far it must look (inclusive), offer() takes
// an admitted hit and returns true to stop.

// The closest t, and among the hits that tie with it the lowest (object, primitive). A tie's window
// moves when a closer hit turns up; `ambiguous` says that a hit was dropped that the final window
// might have held, and that LowestInWindow must decide.
class ClosestSearch {
public:
    explicit ClosestSearch(float t_max) : limit_(t_max) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit& hit) {
        if (hit.t < closest_) {
            closest_ = hit.t;
            limit_ = std::min(limit_, tie_limit(closest_));
        }
        if (!winner_.valid()) {
            winner_ = hit;
        } else if (winner_.t > limit_) {
            ambiguous_ = ambiguous_ || dropped_;
            winner_ = hit;
        } else {
            dropped_ = true;
            if (precedes(hit, winner_)) winner_ = hit;
        }
        return false;
    }

    [[nodiscard]] const Hit& winner() const { return winner_; }
    [[nodiscard]] bool ambiguous() const { return ambiguous_; }

private:
    float limit_;
    float closest_ = std::numeric_limits<float>::infinity();
    Hit winner_;
    bool dropped_ = false;
    bool ambiguous_ = false;
};

class LowestInWindow {
public:
    explicit LowestInWindow(float limit) : limit_(limit) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit& hit) {
        if (!winner_.valid() || precedes(hit, winner_)) winner_ = hit;
        return false;
    }
    [[nodiscard]] const Hit& winner() const { return winner_; }

private:
    float limit_;
    Hit winner_;
};

class AnySearch {
public:
    explicit AnySearch(float t_max) : limit_(t_max) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit&) {
        found_ = true;
        return true;
    }
    [[nodiscard]] bool found() const { return found_; }

private:
    float limit_;
    bool found_ = false;
};

class AllSearch {
public:
    explicit AllSearch(float t_max) : limit_(t_max) {}

    [[nodiscard]] float limit() const { return limit_; }
    bool offer(const Hit& hit) {
        hits_.push_back(hit);
        return false;
    }
    [[nodiscard]] std::vector<Hit> sorted() && {
        std::sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) {
            return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
        });
        return std::move(hits_);
    }

private:
    float limit_;
    std::vector<Hit> hits_;
};

ObjectRay object_ray(const Instance& instance, const Ray& ray) {
    if (instance.identity) return {glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
    return {instance.object_from_world.point(glm::dvec3(ray.origin)),
            instance.object_from_world.vector(glm::dvec3(ray.direction))};
}

bool usable(const Ray& ray) {
    const glm::vec3 sum = ray.origin + ray.direction;
    const bool finite = std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
    return finite && ray.direction != glm::vec3(0.0f) && ray.t_min < ray.t_max;
}

}  // namespace

struct Accel::State {
    std::shared_ptr<const Scene> scene;
    std::vector<std::shared_ptr<const MeshTree>> trees;  // one a mesh
    std::vector<Instance> instances;                     // one an object
    Bvh top;                                             // over the finite objects
    std::vector<std::uint32_t> unbounded;                // infinite planes
    Bounds bounds;

    void build_trees(const BuildOptions& options, const Accel* reuse);
    void place_objects(const BuildOptions& options);

    template <typename Search>
    bool trace_object(std::uint32_t index, const Ray& ray, const RayQuery& query,
                      Search& search) const;
    template <typename Search>
    bool trace_mesh(const Object& object, const Instance& instance, const ObjectRay& local,
                    const Ray& ray, const RayQuery& query, Search& search) const;
    template <typename Search>
    void trace(const Ray& ray, const RayQuery& query, Search& search) const;
};

void Accel::State::build_trees(const BuildOptions& options, const Accel* reuse) {
    trees.reserve(scene->meshes.size());
    for (const Mesh& mesh : scene->meshes) {
        std::shared_ptr<const MeshTree> tree;
        if (reuse != nullptr) {
            const auto& known = reuse->state_->trees;
            const auto found = std::find_if(known.begin(), known.end(), [&](const auto& other) {
                return same_arrays(*other, mesh);
            });
            if (found != known.end()) tree = *found;
        }
        if (!tree) tree = std::make_shared<const MeshTree>(build_tree(mesh, options));
        trees.push_back(std::move(tree));
    }
}

void Accel::State::place_objects(const BuildOptions& options) {
    std::vector<Bounds> boxes;
    boxes.reserve(scene->objects.size());
    instances.reserve(scene->objects.size());
    for (const Object& object : scene->objects) {
        Instance instance;
        instance.identity = object.world_from_object.is_identity();
        instance.object_from_world = inverse(object.world_from_object).value_or(Transform{});
        if (const auto* use = std::get_if<MeshInstance>(&object.shape)) {
            instance.tree = trees[use->mesh].get();
        }
        // Rounding a transformed ray to float moves it by half a unit in the last place of its
        // coordinates; the boxes are widened by several times that.
        if (!instance.identity) instance.slop = 8.0f * 5.9604645e-8f;
        instances.push_back(instance);
        boxes.push_back(object_bounds(*scene, object));
        if (!boxes.back().empty()) {
            bounds.extend(boxes.back());
        } else if (std::holds_alternative<Plane>(object.shape)) {
            unbounded.push_back(static_cast<std::uint32_t>(instances.size() - 1));
        }
    }
    top = build_bvh(boxes, options.threads, options.stop);
}

template <typename Search>
bool Accel::State::trace_mesh(const Object& object, const Instance& instance,
                              const ObjectRay& local, const Ray& ray, const RayQuery& query,
                              Search& search) const {
    const MeshTree& tree = *instance.tree;
    if (tree.bvh.nodes.empty()) return false;
    const glm::vec3 origin(local.origin);
    const Bounds& box = tree.bvh.nodes[0].bounds;
    const glm::vec3 reach =
        glm::max(glm::abs(origin), glm::max(glm::abs(box.min), glm::abs(box.max)));
    const SlabRay slabs(origin, glm::vec3(local.direction),
                        instance.slop * std::max({reach.x, reach.y, reach.z}));
    const ShearedRay sheared = shear(local);
    return traverse(
        tree.bvh, slabs, ray.t_min, [&] { return search.limit(); },
        [&](std::uint32_t primitive) {
            const glm::uvec3 corner = tree.triangles[primitive];
            const auto found = intersect_triangle(sheared, glm::dvec3(tree.positions[corner.x]),
                                                  glm::dvec3(tree.positions[corner.y]),
                                                  glm::dvec3(tree.positions[corner.z]));
            if (!found) return false;
            const auto t = static_cast<float>(found->t);
            if (!(t > ray.t_min && t < ray.t_max && t <= search.limit())) return false;
            const Hit hit{object.id, primitive, t, glm::vec2(found->u, found->v),
                          found->front_face};
            return admitted(ray, query, hit) && search.offer(hit);
        });
}

template <typename Search>
bool Accel::State::trace_object(std::uint32_t index, const Ray& ray, const RayQuery& query,
                                Search& search) const {
    const Object& object = scene->objects[index];
    if ((object.mask & query.mask) == 0) return false;
    const Instance& instance = instances[index];
    const ObjectRay local = object_ray(instance, ray);
    if (instance.tree != nullptr) {
        return trace_mesh(object, instance, local, ray, query, search);
    }
    const ShapeHits hits = std::visit(
        [&](const auto& shape) -> ShapeHits {
            if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, MeshInstance>) {
                return {};
            } else {
                return raypick::intersect(shape, local);
            }
        },
        object.shape);
    for (int i = 0; i < hits.count; ++i) {
        const ShapeHit& found = hits.hit[i];
        const auto t = static_cast<float>(found.t);
        if (!(t > ray.t_min && t < ray.t_max && t <= search.limit())) continue;
        const Hit hit{object.id, found.primitive, t, glm::vec2(found.uv),
                      glm::dot(found.normal, local.direction) < 0.0};
        if (admitted(ray, query, hit) && search.offer(hit)) return true;
    }
    return false;
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
    state->build_trees(options, reuse);
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
    for (const auto& tree : state_->trees) {
        stats.triangles += tree->triangle_count;
        stats.nodes += tree->bvh.nodes.size();
        stats.bytes += tree->bvh.bytes();
    }
    return stats;
}

}  // namespace raypick
