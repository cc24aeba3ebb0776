#include "tracer/accel/trees.h"

#include "tracer/accel/mesh_corners.h"
#include "tracer/bvh/bvh_fast.h"
#include "tracer/error.h"
#include "tracer/geometry/rounding.h"
#include "tracer/parallel/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
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
    std::array<const void*, 2> arrays{};
    std::size_t count = 0;
    BoxSource boxes;
    LeafCosts costs;
    const Mesh* mesh = nullptr;  // whose triangles go into patches
};

template <typename BoxOf>
BoxSource one_by_one(const BoxOf& box_of) {
    return [box_of](std::size_t first, std::span<Bounds> boxes) {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = box_of(first + i);
    };
}

TreeSource source_of(const Mesh& mesh) {
    return {{mesh.positions.data(), mesh.triangles.data()},
            mesh.triangles.size(),
            one_by_one([&mesh](std::size_t i) { return triangle_box(mesh, i).bounds(); }),
            kWideSurfaceLeaves,
            &mesh};
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
        return tree->arrays == source.arrays && tree->count == source.count &&
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
    if (source.mesh != nullptr) {
        tree.patches = take_triangles(tree.bvh, *source.mesh, how.threads, how.stop);
    }
}

void build_first_tree(PrimitiveTree& tree, const TreeSource& source, const BvhOptions& how) {
    if (source.mesh == nullptr) {
        tree.bvh = build_bvh_fast(source.count, source.boxes, how);
        return;
    }
    const Mesh& mesh = *source.mesh;
    // Not where the mesh is likely to use only some of its positions.
    const bool dense = mesh.positions.size() <= 4 * source.count;
    const Box4 around = dense ? box_around(mesh.positions, how.threads, how.stop) : Box4{};
    const Box4Source boxes = [&mesh](std::size_t first, std::span<Box4> wanted) {
        for (std::size_t i = 0; i < wanted.size(); ++i)
            wanted[i] = triangle_box(mesh, first + i);
    };
    LargeArray<MortonKey> keys = morton_order(source.count, boxes, around, how);
    PatchStore store(mesh, keys.size());
    tree.bvh = build_over_keys(std::move(keys), store.leaves(), how);
    tree.patches = store.take();
}

std::shared_ptr<const PrimitiveTree> build_tree(const TreeSource& source,
                                                const BuildOptions& options, int threads) {
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
    return std::make_shared<const PrimitiveTree>(std::move(tree));
}

// From so many primitives on a tree is built on all threads: from a share of all primitives that
// would keep one thread busy after the others are done.
std::size_t least_for_all_threads(std::span<const TreeSource> sources, int threads) {
    constexpr std::size_t kLeast = 1u << 13;
    std::size_t sum = 0;
    for (const TreeSource& source : sources)
        sum += source.count;
    const int workers = threads > 0 ? threads : hardware_threads();
    return std::max(kLeast, sum / (4u * static_cast<std::size_t>(workers)));
}

// Large trees one after the other, each on all threads; then the others side by side, each on one,
// the largest first, so that no thread begins with one when the others are done.
void build_missing(TreeList& trees, std::span<const TreeSource> sources,
                   const BuildOptions& options) {
    const std::size_t large = least_for_all_threads(sources, options.threads);
    std::vector<std::size_t> small;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (trees[i] != nullptr) continue;
        if (sources[i].count >= large) {
            trees[i] = build_tree(sources[i], options, options.threads);
        } else {
            small.push_back(i);
        }
    }
    std::stable_sort(small.begin(), small.end(), [&](std::size_t a, std::size_t b) {
        return sources[a].count > sources[b].count;
    });
    parallel_for(small.size(), options.threads, options.stop, [&](std::size_t i) {
        trees[small[i]] = build_tree(sources[small[i]], options, 1);
    });
    if (options.stop.stop_requested()) throw Cancelled();
}

// One tree for each mesh or set of `things`.
template <typename Things>
TreeList build_list(const Things& things, const BuildOptions& options, const TreeList* known) {
    std::vector<TreeSource> sources;
    TreeList trees;
    for (const auto& thing : things) {
        sources.push_back(source_of(thing));
        trees.push_back(known != nullptr ? find_tree(*known, sources.back(), options.quality)
                                         : nullptr);
    }
    build_missing(trees, sources, options);
    return trees;
}

}  // namespace

SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse) {
    const auto known = [reuse](TreeList SceneTrees::*list) {
        return reuse != nullptr ? &(reuse->*list) : nullptr;
    };
    return {build_list(scene.meshes, options, known(&SceneTrees::meshes)),
            build_list(scene.sphere_sets, options, known(&SceneTrees::sphere_sets)),
            build_list(scene.cone_sets, options, known(&SceneTrees::cone_sets))};
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
