#include "tracer/accel/trees.h"

#include "tracer/accel/triangle_box.h"
#include "tracer/bvh/bvh_fast.h"
#include "tracer/error.h"
#include "tracer/geometry/rounding.h"
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

Bounds sphere_box(const SphereSet& set, std::size_t index) {
    const Sphere sphere = sphere_of(set, static_cast<std::uint32_t>(index));
    return rounded_outwards(sphere.centre - sphere.radius, sphere.centre + sphere.radius);
}

// Of the two disks at the ends.
Bounds cone_box(const ConeSet& set, std::size_t index) {
    const Cone cone = cone_of(set, static_cast<std::uint32_t>(index));
    const ObjectExtent extent = shape_extent(cone);
    return rounded_outwards(extent.min, extent.max);
}

// The arrays that a tree is built over, and how many primitives and which boxes they make.
struct TreeSource {
    TreeArrays arrays{};
    std::size_t count = 0;
    BoxSource boxes;
    LeafCosts costs;
    std::shared_ptr<const JoinedMeshes> meshes = nullptr;  // whose triangles go into patches
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

TreeSource source_of(const Mesh& mesh) {
    TreeSource source = source_of(std::vector<const Mesh*>{&mesh});
    source.arrays = arrays_of(mesh);
    return source;
}

TreeSource source_of(const SphereSet& set) {
    return {{set.spheres.data(), nullptr},
            set.spheres.size(),
            one_by_one([&set](std::size_t i) { return sphere_box(set, i); }),
            kWideLeaves};
}

TreeSource source_of(const ConeSet& set) {
    return {{set.ends.data(), nullptr},
            set.size(),
            one_by_one([&set](std::size_t i) { return cone_box(set, i); }),
            kWideLeaves};
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
}

// Of one mesh or set: first trees are not of joined meshes.
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
                    const std::vector<bool>& without = {}) {
    std::vector<TreeSource> sources;
    std::vector<std::size_t> places;
    TreeList found;
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (!without.empty() && without[i]) continue;
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

std::shared_ptr<const JoinedTree> join_meshes(const Scene& scene, const BuildOptions& options) {
    std::vector<const Mesh*> meshes;
    JoinedTree joined;
    for (const JoinableMesh& joinable : joinable_meshes(scene, options)) {
        meshes.push_back(joinable.mesh);
        joined.members.push_back(arrays_of(*joinable.mesh));
        joined.bounds.push_back(joinable.bounds);
    }
    if (meshes.empty()) return nullptr;
    joined.tree = build_tree(source_of(std::move(meshes)), options, options.threads);
    return std::make_shared<const JoinedTree>(std::move(joined));
}

// Whether most triangles of a joined tree are still there.
bool still_pays(const JoinedTree& joined, const Scene& scene,
                const std::vector<std::uint32_t>& objects) {
    std::size_t there = 0;
    for (const std::uint32_t object : objects) {
        if (object == kNobody) continue;
        const auto& instance = std::get<MeshInstance>(scene.objects[object].shape);
        there += scene.meshes[instance.mesh].triangles.size();
    }
    return there > joined.tree.count / 2;
}

// Whether some mesh has a tree for many rays.
bool has_quality_tree(const SceneTrees& trees) {
    return std::any_of(trees.meshes.begin(), trees.meshes.end(), [](const auto& tree) {
        return tree != nullptr && tree->quality == TreeQuality::many_rays;
    });
}

// What already has trees of its own for many rays keeps them: edits are not to wait for others.
void set_joined(SceneTrees& trees, const Scene& scene, const BuildOptions& options,
                const SceneTrees* reuse) {
    if (options.quality != TreeQuality::many_rays) return;
    if (reuse != nullptr && reuse->joined == nullptr && has_quality_tree(*reuse)) return;
    if (reuse != nullptr && reuse->joined != nullptr) {
        trees.joined_objects = objects_of_members(scene, reuse->joined->members);
        if (still_pays(*reuse->joined, scene, trees.joined_objects)) {
            trees.joined = reuse->joined;
            return;
        }
    }
    trees.joined = join_meshes(scene, options);
    trees.joined_objects.clear();
    if (trees.joined == nullptr) return;
    trees.joined_objects = objects_of_members(scene, trees.joined->members);
}

// By mesh: whether all its objects stand in the joined tree.
std::vector<bool> meshes_joined(const Scene& scene, const SceneTrees& trees) {
    std::vector<std::uint32_t> others = count_uses(scene);
    std::vector<bool> joined(scene.meshes.size());
    for (const std::uint32_t object : trees.joined_objects) {
        if (object == kNobody) continue;
        const MeshId mesh = std::get<MeshInstance>(scene.objects[object].shape).mesh;
        joined[mesh] = --others[mesh] == 0;
    }
    return joined;
}

}  // namespace

SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse) {
    const auto known = [reuse](TreeList SceneTrees::*list) {
        return reuse != nullptr ? &(reuse->*list) : nullptr;
    };
    SceneTrees trees;
    set_joined(trees, scene, options, reuse);
    trees.meshes =
        build_list(scene.meshes, options, known(&SceneTrees::meshes), meshes_joined(scene, trees));
    trees.sphere_sets = build_list(scene.sphere_sets, options, known(&SceneTrees::sphere_sets));
    trees.cone_sets = build_list(scene.cone_sets, options, known(&SceneTrees::cone_sets));
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
