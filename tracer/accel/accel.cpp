#include "tracer/accel/accel.h"

#include "tracer/accel/accel_state.h"
#include "tracer/accel/cut_out.h"
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
// their parts would have rays to be transformed again.
void open_entries(const AccelState& state, std::vector<PlacedEntry>& entries,
                  const std::stop_token& stop) {
    constexpr std::size_t kMostParts = 64;  // an object, on average
    if (entries.size() < 2) return;
    const std::size_t most = entries.size() * kMostParts;
    using Candidate = std::pair<float, std::size_t>;  // area, which
    std::priority_queue<Candidate> candidates;
    const auto consider = [&](std::size_t which) {
        const TopEntry& entry = entries[which].entry;
        const Instance& instance = state.instances[entry.object];
        if (!instance.identity || instance.tree == nullptr || entry.part.is_leaf()) return;
        candidates.emplace(entries[which].box.half_area(), which);
    };
    for (std::size_t i = 0; i < entries.size(); ++i)
        consider(i);
    while (!candidates.empty() && entries.size() + kWidth <= most) {
        throw_if_stopped(stop);
        const std::size_t which = candidates.top().second;
        candidates.pop();
        const std::size_t before = entries.size();
        open_entry(state, which, entries);
        consider(which);
        for (std::size_t i = before; i < entries.size(); ++i)
            consider(i);
    }
}

void place_objects(AccelState& state, const BuildOptions& options) {
    const Scene& scene = *state.scene;
    std::vector<PlacedEntry> entries;
    state.instances.reserve(scene.objects.size());
    for (const Object& object : scene.objects) {
        throw_if_stopped(options.stop);
        const auto index = static_cast<std::uint32_t>(state.instances.size());
        state.instances.push_back(instance_of(scene, object, state.trees));
        const PrimitiveTree* tree = state.instances.back().tree;
        const Bounds box = instance_bounds(scene, object, tree);
        if (!box.empty()) {
            state.bounds.extend(box);
            entries.push_back({{index, tree != nullptr ? tree->bvh.root : WideRef{}}, box});
        } else if (std::holds_alternative<Plane>(object.shape)) {
            state.unbounded.push_back(index);
        }
    }
    open_entries(state, entries, options.stop);
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

bool mostly_triangles(const SceneTrees& trees) {
    const auto primitives = [](const TreeList& list) {
        std::size_t sum = 0;
        for (const auto& tree : list)
            sum += tree->count;
        return sum;
    };
    return primitives(trees.meshes) > primitives(trees.sphere_sets) + primitives(trees.cone_sets);
}

}  // namespace

struct Accel::State : AccelState {};

Accel::Accel(std::shared_ptr<const Scene> scene, const BuildOptions& options, const Accel* reuse) {
    check_scene(*scene);
    auto state = std::make_unique<State>();
    state->scene = std::move(scene);
    state->trees =
        build_trees(*state->scene, options, reuse != nullptr ? &reuse->state_->trees : nullptr);
    state->mostly_triangles = mostly_triangles(state->trees);
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
    const auto count = [&stats](const TreeList& trees, std::uint64_t& primitives) {
        for (const auto& tree : trees) {
            primitives += tree->count;
            stats.nodes += tree->bvh.nodes.size();
            stats.bytes += tree->bytes();
        }
    };
    count(state_->trees.meshes, stats.triangles);
    count(state_->trees.sphere_sets, stats.spheres);
    count(state_->trees.cone_sets, stats.cones);
    return stats;
}

}  // namespace raypick
