#include "tracer/accel/accel.h"

#include "tracer/accel/accel_state.h"
#include "tracer/accel/cut_out.h"
#include "tracer/accel/trace_crossings.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/error.h"

#include <glm/common.hpp>

#include <algorithm>
#include <queue>
#include <utility>
#include <variant>

namespace raypick {

namespace {

// What has a tree knows its box already.
Bounds instance_bounds(const Scene& scene, const Object& object, const PrimitiveTree* tree) {
    if (tree == nullptr) return object_bounds(scene, object);
    const Bounds& box = tree->bvh.bounds;
    if (box.empty()) return {};
    return world_bounds(object.world_from_object, glm::dvec3(box.min), glm::dvec3(box.max));
}

Instance instance_of(const Scene& scene, const Object& object, const SceneTrees& trees) {
    Instance instance;
    instance.identity = object.world_from_object.is_identity();
    instance.object_from_world = inverse(object.world_from_object).value_or(Transform{});
    instance.holes = may_be_cut_out(scene, object);
    instance.tree = tree_of(trees, object.shape);
    // Rounding a transformed ray to float moves it by half a unit in the last place of its
    // coordinates; the boxes are widened by several times that.
    if (!instance.identity) instance.slop = 8.0f * 5.9604645e-8f;
    return instance;
}

void throw_if_stopped(const std::stop_token& stop) {
    if (stop.stop_requested()) throw Cancelled();
}

// An entry of the top tree, and its box in the world.
struct PlacedEntry {
    TopEntry entry;
    Bounds box;
};

// Puts an entry's children in its place, those of a node of its object's tree.
void open_entry(const AccelState& state, std::size_t which, std::vector<PlacedEntry>& entries) {
    const TopEntry opened = entries[which].entry;
    const WideNode& node = state.instances[opened.object].tree->bvh.nodes[opened.part.index()];
    bool first = true;
    for (std::uint32_t i = 0; i < kWidth; ++i) {
        if (node.child[i] == WideRef::kNothing) continue;
        const PlacedEntry child{{opened.object, node.ref(i)}, node.box(i)};
        if (first) {
            entries[which] = child;
        } else {
            entries.push_back(child);
        }
        first = false;
    }
}

// Opens objects that lie in each other's way, the largest boxes first, so that the top tree can
// tell their parts apart (Benthin, Woop, Wald, Afra, "Improved Two-Level BVHs using Partial
// Re-Braiding", HPG 2017). Objects that stand elsewhere than their shapes remain whole, as each of
// their parts would have rays to be transformed again; so do joined trees, which know more of their
// parts than the top tree can.
void open_entries(const AccelState& state, std::vector<PlacedEntry>& entries,
                  const BuildOptions& options) {
    // An object, on average.
    const std::size_t most_parts = options.quality == TreeQuality::first ? 16 : 64;
    if (entries.size() < 2) return;
    const std::size_t most = entries.size() * most_parts;
    using Candidate = std::pair<float, std::size_t>;  // area, which
    std::priority_queue<Candidate> candidates;
    const auto consider = [&](std::size_t which) {
        const TopEntry& entry = entries[which].entry;
        const Instance& instance = state.instances[entry.object];
        if (!instance.identity || instance.tree == nullptr || entry.part.is_leaf()) return;
        if (instance.joined()) return;
        candidates.emplace(entries[which].box.half_area(), which);
    };
    for (std::size_t i = 0; i < entries.size(); ++i)
        consider(i);
    while (!candidates.empty() && entries.size() + kWidth <= most) {
        throw_if_stopped(options.stop);
        const std::size_t which = candidates.top().second;
        candidates.pop();
        const std::size_t before = entries.size();
        open_entry(state, which, entries);
        consider(which);
        for (std::size_t i = before; i < entries.size(); ++i)
            consider(i);
    }
}

// A joined tree's entry, and what it needs to tell its objects apart.
void place_joined(AccelState& state, const JoinedInScene& joined, std::vector<Member>& members,
                  std::vector<PlacedEntry>& entries) {
    if (joined.tree == nullptr) return;
    Bounds box;
    for (std::size_t i = 0; i < joined.objects.size(); ++i) {
        const std::uint32_t object = joined.objects[i];
        const bool there = object != kNobody;
        members.push_back({object, there ? &state.instances[object] : nullptr});
        if (there) box.extend(joined.tree->bounds[i]);
    }
    if (box.empty()) return;
    state.bounds.extend(box);
    const PrimitiveTree& tree = joined.tree->tree;
    Instance instance;
    instance.tree = &tree;
    instance.members = members;
    const auto index = static_cast<std::uint32_t>(state.instances.size());
    state.instances.push_back(instance);
    entries.push_back({{index, tree.bvh.root}, tree.bvh.bounds});
}

void place_objects(AccelState& state, const BuildOptions& options) {
    const Scene& scene = *state.scene;
    std::vector<PlacedEntry> entries;
    state.instances.reserve(scene.objects.size() + 2);  // they are pointed to
    std::vector<bool> joined(scene.objects.size());
    for (const JoinedInScene* with : {&state.trees.joined_meshes, &state.trees.joined_sets}) {
        for (const std::uint32_t object : with->objects) {
            if (object != kNobody) joined[object] = true;
        }
    }
    for (std::uint32_t index = 0; index < scene.objects.size(); ++index) {
        throw_if_stopped(options.stop);
        const Object& object = scene.objects[index];
        state.instances.push_back(instance_of(scene, object, state.trees));
        if (joined[index]) continue;
        const PrimitiveTree* tree = state.instances.back().tree;
        const Bounds box = instance_bounds(scene, object, tree);
        if (!box.empty()) {
            state.bounds.extend(box);
            entries.push_back({{index, tree != nullptr ? tree->bvh.root : WideRef{}}, box});
        } else if (std::holds_alternative<Plane>(object.shape)) {
            state.unbounded.push_back(index);
        }
    }
    place_joined(state, state.trees.joined_meshes, state.mesh_members, entries);
    place_joined(state, state.trees.joined_sets, state.set_members, entries);
    open_entries(state, entries, options);
    std::vector<Bounds> boxes;
    for (const PlacedEntry& placed : entries) {
        state.entries.push_back(placed.entry);
        boxes.push_back(placed.box);
    }
    // Each entry in a box of its own, as entering it costs more than a look at its box.
    const BoxSource source = [&boxes](std::size_t first, std::span<Bounds> wanted) {
        std::copy_n(boxes.begin() + static_cast<std::ptrdiff_t>(first), wanted.size(),
                    wanted.begin());
    };
    const BvhOptions how{
        .costs = {.max_leaf = 1}, .threads = options.threads, .stop = options.stop};
    state.top = widen(build_bvh(boxes.size(), source, how), options.threads, options.stop);
    if (!state.bounds.empty()) {
        const glm::vec3 farthest = glm::max(glm::abs(state.bounds.min), glm::abs(state.bounds.max));
        state.reach = std::max({farthest.x, farthest.y, farthest.z});
    }
}

struct PrimitiveCounts {
    std::uint64_t triangles = 0;
    std::uint64_t spheres = 0;
    std::uint64_t cones = 0;
};

// Of unique meshes and sets.
PrimitiveCounts count_primitives(const Scene& scene) {
    PrimitiveCounts counts;
    for (const Mesh& mesh : scene.meshes)
        counts.triangles += mesh.triangles.size();
    for (const SphereSet& set : scene.sphere_sets)
        counts.spheres += set.spheres.size();
    for (const ConeSet& set : scene.cone_sets)
        counts.cones += set.size();
    return counts;
}

}  // namespace

struct Accel::State : AccelState {};

Accel::Accel(std::shared_ptr<const Scene> scene, const BuildOptions& options, const Accel* reuse) {
    check_scene(*scene);
    auto state = std::make_unique<State>();
    state->scene = std::move(scene);
    state->trees =
        build_trees(*state->scene, options, reuse != nullptr ? &reuse->state_->trees : nullptr);
    const PrimitiveCounts counts = count_primitives(*state->scene);
    state->has_spheres = counts.spheres > 0;
    state->mostly_triangles = counts.triangles > counts.spheres + counts.cones;
    place_objects(*state, options);
    state_ = std::move(state);
}

Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;

std::optional<Hit> Accel::intersect(const Ray& ray, const RayQuery& query) const {
    return closest_hit(*state_, ray, query);
}

bool Accel::occluded(const Ray& ray, const RayQuery& query) const {
    return any_hit(*state_, ray, query);
}

std::vector<Hit> Accel::intersect_all(const Ray& ray, const RayQuery& query) const {
    return all_hits(*state_, ray, query);
}

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits, const RayQuery& query) const {
    closest_hits(*state_, rays, hits, query);
}

void Accel::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                     const RayQuery& query) const {
    any_hits(*state_, rays, blocked, query, nullptr);
}

void Accel::occluded_towards(const glm::vec3& end, std::span<const Ray> rays,
                             std::span<std::uint8_t> blocked, const RayQuery& query) const {
    any_hits(*state_, rays, blocked, query, &end);
}

void Accel::cross(std::span<const Ray> rays, const Clearness& clear, Crossings& crossings,
                  const RayQuery& query) const {
    find_crossings(*state_, rays, clear, crossings, query, nullptr);
}

void Accel::cross_towards(const glm::vec3& end, std::span<const Ray> rays, const Clearness& clear,
                          Crossings& crossings, const RayQuery& query) const {
    find_crossings(*state_, rays, clear, crossings, query, &end);
}

const Scene& Accel::scene() const {
    return *state_->scene;
}
std::shared_ptr<const Scene> Accel::shared_scene() const {
    return state_->scene;
}
const Transform& Accel::object_from_world(std::size_t object_index) const {
    return state_->instances[object_index].object_from_world;
}
const Bounds& Accel::bounds() const {
    return state_->bounds;
}

AccelStats Accel::stats() const {
    AccelStats stats;
    stats.bytes = state_->top.bytes() + state_->instances.size() * sizeof(Instance) +
                  state_->entries.size() * sizeof(TopEntry);
    stats.nodes = state_->top.nodes.size();
    const auto add = [&stats](const PrimitiveTree& tree) {
        stats.nodes += tree.bvh.nodes.size();
        stats.bytes += tree.bytes();
    };
    const SceneTrees& trees = state_->trees;
    for (const TreeList* list : {&trees.meshes, &trees.sphere_sets, &trees.cone_sets}) {
        for (const auto& tree : *list) {
            if (tree != nullptr) add(*tree);
        }
    }
    for (const JoinedInScene* joined : {&trees.joined_meshes, &trees.joined_sets}) {
        if (joined->tree != nullptr) add(joined->tree->tree);
    }
    const PrimitiveCounts counts = count_primitives(*state_->scene);
    stats.triangles = counts.triangles;
    stats.spheres = counts.spheres;
    stats.cones = counts.cones;
    return stats;
}

}  // namespace raypick
