#include "tracer/accel/trees.h"

#include "tracer/accel/element_box.h"
#include "tracer/accel/triangle_box.h"
#include "tracer/bvh/bvh_fast.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>
#include <variant>

namespace raypick {

namespace {

// The arrays that a tree is built over, and how many primitives and which boxes they make.
struct TreeSource {
    TreeArrays arrays{};
    std::size_t count = 0;
    BoxSource boxes;
    LeafCosts costs;
    std::shared_ptr<const JoinedMeshes> meshes = nullptr;  // whose triangles go into patches
    std::shared_ptr<const JoinedSets> sets = nullptr;      // whose elements are taken along
};

template <typename BoxOf>
BoxSource one_by_one(const BoxOf& box_of) {
    return [box_of](std::size_t first, std::span<Bounds> boxes) {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = box_of(first + i);
    };
}

TreeSource source_of(std::vector<const Mesh*> several) {
    auto meshes = std::make_shared<const JoinedMeshes>(std::move(several));
    const auto boxes = [meshes](std::size_t first, std::span<Bounds> wanted) {
        std::size_t member = meshes->member_of(first);
        for (std::size_t i = first; i < first + wanted.size(); ++i) {
            if (i >= meshes->first(member + 1)) ++member;
            wanted[i - first] = triangle_box(meshes->mesh(member), i - meshes->first(member));
        }
    };
    return {{}, meshes->triangles(), boxes, kWideSurfaceLeaves, meshes};
}

TreeSource source_of(std::vector<JoinableSet> several) {
    const auto sets = std::make_shared<const JoinedSets>(std::move(several));
    const auto boxes = [sets](std::size_t first, std::span<Bounds> wanted) {
        std::size_t member = sets->member_of(first);
        for (std::size_t i = first; i < first + wanted.size(); ++i) {
            while (i >= sets->first(member + 1))
                ++member;
            wanted[i - first] = sets->set(member).element_bounds(i - sets->first(member));
        }
    };
    const bool mixed = sets->first_cone() < sets->elements();
    return {{}, sets->elements(), boxes, mixed ? kMixedLeaves : kWideLeaves, nullptr, sets};
}

TreeSource source_of(const Mesh& mesh) {
    TreeSource source = source_of(std::vector<const Mesh*>{&mesh});
    source.arrays = arrays_of(mesh);
    return source;
}

TreeSource source_of(const SphereSet& set) {
    return {arrays_of(set), set.spheres.size(),
            one_by_one([&set](std::size_t i) { return element_box(set, i); }), kWideLeaves};
}

TreeSource source_of(const ConeSet& set) {
    return {arrays_of(set), set.size(),
            one_by_one([&set](std::size_t i) { return element_box(set, i); }), kWideLeaves};
}

std::shared_ptr<const PrimitiveTree> find_tree(const TreeList& known, const TreeSource& source,
                                               TreeQuality quality) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& tree) {
        return tree != nullptr && tree->arrays == source.arrays && tree->count == source.count &&
               tree->quality >= quality;
    });
    return found != known.end() ? *found : nullptr;
}

// Around the positions, those apart that are not finite.
Box4 box_around(std::span<const glm::vec3> positions, int threads, const std::stop_token& stop) {
    constexpr std::size_t kChunk = 1u << 15;
    std::vector<Box4> boxes((positions.size() + kChunk - 1) / kChunk);
    parallel_for(boxes.size(), threads, stop, [&](std::size_t i) {
        const std::size_t end = std::min(positions.size(), (i + 1) * kChunk);
        Box4 box;
        for (std::size_t k = i * kChunk; k < end; ++k) {
            const glm::vec3 p = positions[k];
            const Float4 at{p.x, p.y, p.z, 0.0f};
            const Float4 known = at + 0.0f * at;  // NaN where it is not finite
            box.min = min4(known, box.min);
            box.max = max4(known, box.max);
        }
        boxes[i] = box;
    });
    Box4 box;
    for (const Box4& some : boxes)
        box.extend(some);
    return box;
}

void build_quality_tree(PrimitiveTree& tree, const TreeSource& source, const BvhOptions& how) {
    tree.bvh = widen(build_bvh(source.count, source.boxes, how), how.threads, how.stop);
    if (source.meshes != nullptr) {
        tree.patches = take_triangles(tree.bvh, *source.meshes, how.threads, how.stop);
    }
    if (source.sets != nullptr) {
        tree.elements = take_elements(tree.bvh, *source.sets, how.threads, how.stop);
    }
}

// Of one mesh or set: first trees are not of joined ones.
void build_first_tree(PrimitiveTree& tree, const TreeSource& source, const BvhOptions& how) {
    if (source.meshes == nullptr) {
        tree.bvh = build_bvh_fast(source.count, source.boxes, how);
        return;
    }
    assert(source.meshes->size() == 1);
    const Mesh& mesh = source.meshes->mesh(0);
    // Not where the mesh is likely to use only some of its positions.
    const bool dense = mesh.positions.size() <= 4 * source.count;
    const Box4 around = dense ? box_around(mesh.positions, how.threads, how.stop) : Box4{};
    const Box4Source boxes = [&mesh](std::size_t first, std::span<Box4> wanted) {
        for (std::size_t i = 0; i < wanted.size(); ++i)
            wanted[i] = triangle_box4(mesh, first + i);
    };
    LargeArray<MortonKey> keys = morton_order(source.count, boxes, around, how);
    PatchStore store(*source.meshes, keys.size());
    tree.bvh = build_over_keys(std::move(keys), store.leaves(), how);
    tree.patches = store.take();
}

PrimitiveTree build_tree(const TreeSource& source, const BuildOptions& options, int threads) {
    PrimitiveTree tree;
    tree.arrays = source.arrays;
    tree.count = source.count;
    tree.quality = options.quality;
    const BvhOptions how{.costs = source.costs, .threads = threads, .stop = options.stop};
    if (options.quality == TreeQuality::first) {
        build_first_tree(tree, source, how);
    } else {
        build_quality_tree(tree, source, how);
    }
    const Bounds& box = tree.bvh.bounds;
    const glm::vec3 farthest = glm::max(glm::abs(box.min), glm::abs(box.max));
    tree.reach = std::max({farthest.x, farthest.y, farthest.z});
    return tree;
}

// From so many primitives on a tree is built on all threads: from a share of all primitives that
// would keep one thread busy after the others are done.
std::size_t least_for_all_threads(std::span<const TreeSource> sources, int threads) {
    constexpr std::size_t kLeast = 1u << 13;
    std::size_t sum = 0;
    for (const TreeSource& source : sources)
        sum += source.count;
    const int workers = threads > 0 ? threads : hardware_threads();
    return std::max(kLeast, sum / (2u * static_cast<std::size_t>(workers)));
}

// Those that `trees` lacks: large ones one after the other, each on all threads; then the others
// side by side, each on one, the largest first, so that no thread begins with one when the others
// are done.
void build_missing(TreeList& trees, std::span<const TreeSource> sources,
                   const BuildOptions& options) {
    const std::size_t large = least_for_all_threads(sources, options.threads);
    const auto build = [&](std::size_t i, int threads) {
        trees[i] = std::make_shared<const PrimitiveTree>(build_tree(sources[i], options, threads));
    };
    std::vector<std::size_t> small;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (trees[i] != nullptr) continue;
        if (sources[i].count >= large) {
            build(i, options.threads);
        } else {
            small.push_back(i);
        }
    }
    std::stable_sort(small.begin(), small.end(), [&](std::size_t a, std::size_t b) {
        return sources[a].count > sources[b].count;
    });
    parallel_for(small.size(), options.threads, options.stop,
                 [&](std::size_t i) { build(small[i], 1); });
    if (options.stop.stop_requested()) throw Cancelled();
}

// One tree for each mesh or set of `things`, but for those `without` one.
template <typename Things>
TreeList build_list(const Things& things, const BuildOptions& options, const TreeList* known,
                    const std::vector<bool>& without) {
    std::vector<TreeSource> sources;
    std::vector<std::size_t> places;
    TreeList found;
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (without[i]) continue;
        places.push_back(i);
        sources.push_back(source_of(things[i]));
        found.push_back(known != nullptr ? find_tree(*known, sources.back(), options.quality)
                                         : nullptr);
    }
    build_missing(found, sources, options);
    TreeList trees(things.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        trees[places[i]] = std::move(found[i]);
    return trees;
}

JoinedMember member_of(const JoinableMesh& joinable) {
    return member_of(*joinable.mesh);
}
JoinedMember member_of(const JoinableSet& joinable) {
    return joinable.spheres != nullptr ? member_of(*joinable.spheres) : member_of(*joinable.cones);
}

TreeSource source_of(const std::vector<JoinableMesh>& joinable) {
    std::vector<const Mesh*> meshes;
    meshes.reserve(joinable.size());
    for (const JoinableMesh& one : joinable)
        meshes.push_back(one.mesh);
    return source_of(std::move(meshes));
}

template <typename Joinable>
std::shared_ptr<const JoinedTree> join(const std::vector<Joinable>& joinable,
                                       const BuildOptions& options) {
    if (joinable.empty()) return nullptr;
    JoinedTree joined;
    for (const Joinable& one : joinable) {
        joined.members.push_back(member_of(one));
        joined.bounds.push_back(one.bounds);
    }
    joined.tree = build_tree(source_of(joinable), options, options.threads);
    return std::make_shared<const JoinedTree>(std::move(joined));
}

// Whether most primitives of a joined tree are still there.
bool still_pays(const JoinedTree& joined, const Scene& scene,
                const std::vector<std::uint32_t>& objects) {
    std::size_t there = 0;
    for (const std::uint32_t object : objects) {
        if (object != kNobody) there += primitive_count(scene, scene.objects[object]);
    }
    return there > joined.tree.count / 2;
}

// Whether some mesh or set has a tree for many rays.
bool has_quality_tree(const TreeList& trees) {
    return std::any_of(trees.begin(), trees.end(), [](const auto& tree) {
        return tree != nullptr && tree->count != 0 && tree->quality == TreeQuality::many_rays;
    });
}

// What was joined before, as far as it still pays.
JoinedInScene kept(const JoinedInScene& before, const Scene& scene) {
    if (before.tree == nullptr) return {};
    JoinedInScene now{before.tree, members_left(scene, before.members), {}};
    now.objects = objects_of_members(scene, now.members);
    return still_pays(*now.tree, scene, now.objects) ? now : JoinedInScene{};
}

// `joinable(scene, options)` says what is to be joined.
template <typename Joinable>
JoinedInScene joined_anew(const Scene& scene, const BuildOptions& options,
                          const Joinable& joinable) {
    JoinedInScene joined;
    joined.tree = join(joinable(scene, options), options);
    if (joined.tree == nullptr) return joined;
    joined.members = joined.tree->members;
    joined.objects = objects_of_members(scene, joined.members);
    return joined;
}

// What already has trees of its own for many rays keeps them: edits are not to wait for others.
void set_joined(SceneTrees& trees, const Scene& scene, const BuildOptions& options,
                const SceneTrees* reuse) {
    if (options.quality != TreeQuality::many_rays) return;
    bool meshes_alone = false;
    bool sets_alone = false;
    if (reuse != nullptr) {
        trees.joined_meshes = kept(reuse->joined_meshes, scene);
        trees.joined_sets = kept(reuse->joined_sets, scene);
        meshes_alone = reuse->joined_meshes.tree == nullptr && has_quality_tree(reuse->meshes);
        sets_alone = reuse->joined_sets.tree == nullptr &&
                     (has_quality_tree(reuse->sphere_sets) || has_quality_tree(reuse->cone_sets));
    }
    if (trees.joined_meshes.tree == nullptr && !meshes_alone) {
        trees.joined_meshes = joined_anew(scene, options, joinable_meshes);
    }
    if (trees.joined_sets.tree == nullptr && !sets_alone) {
        trees.joined_sets = joined_anew(scene, options, joinable_sets);
    }
}

// By mesh or set: whether all its objects stand in a joined tree.
struct StandJoined {
    StandJoined(const Scene& scene, const SceneTrees& trees) {
        Uses others(scene);
        for (const JoinedInScene* joined : {&trees.joined_meshes, &trees.joined_sets}) {
            for (const std::uint32_t object : joined->objects) {
                if (object != kNobody) --*others.of(scene.objects[object].shape);
            }
        }
        const Uses all(scene);
        meshes = without_others(all.meshes, others.meshes);
        sphere_sets = without_others(all.sphere_sets, others.sphere_sets);
        cone_sets = without_others(all.cone_sets, others.cone_sets);
    }

    std::vector<bool> meshes;
    std::vector<bool> sphere_sets;
    std::vector<bool> cone_sets;

private:
    static std::vector<bool> without_others(const std::vector<std::uint32_t>& all,
                                            const std::vector<std::uint32_t>& others) {
        std::vector<bool> joined(all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            joined[i] = all[i] > 0 && others[i] == 0;
        return joined;
    }
};

}  // namespace

SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse) {
    const auto known = [reuse](TreeList SceneTrees::*list) {
        return reuse != nullptr ? &(reuse->*list) : nullptr;
    };
    SceneTrees trees;
    set_joined(trees, scene, options, reuse);
    const StandJoined joined(scene, trees);
    trees.meshes = build_list(scene.meshes, options, known(&SceneTrees::meshes), joined.meshes);
    trees.sphere_sets =
        build_list(scene.sphere_sets, options, known(&SceneTrees::sphere_sets), joined.sphere_sets);
    trees.cone_sets =
        build_list(scene.cone_sets, options, known(&SceneTrees::cone_sets), joined.cone_sets);
    return trees;
}

const PrimitiveTree* tree_of(const SceneTrees& trees, const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshInstance>(&shape)) return trees.meshes[mesh->mesh].get();
    if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
        return trees.sphere_sets[spheres->set].get();
    }
    if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
        return trees.cone_sets[cones->set].get();
    }
    return nullptr;
}

}  // namespace raypick
