#include "tracer/accel/trees.h"

#include "tracer/error.h"
#include "tracer/geometry/rounding.h"
#include "tracer/parallel/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <variant>

namespace raypick {

namespace {

// A triangle with a NaN is never hit: its box stays empty.
Bounds triangle_box(const Mesh& mesh, std::size_t index) {
    const glm::uvec3 t = mesh.triangles[index];
    const glm::vec3 sum = mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z];
    Bounds box;
    if (!std::isfinite(sum.x + sum.y + sum.z)) return box;
    for (int k = 0; k < 3; ++k)
        box.extend(mesh.positions[t[k]]);
    return box;
}

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

template <typename BoxOf>
PrimitiveTree build_tree(const std::array<const void*, 2>& arrays, std::size_t count,
                         const BuildOptions& options, const BoxOf& box_of) {
    constexpr std::size_t kChunk = 1u << 16;
    PrimitiveTree tree;
    tree.arrays = arrays;
    tree.count = count;
    std::vector<Bounds> boxes(count);
    parallel_for((count + kChunk - 1) / kChunk, options.threads, options.stop,
                 [&](std::size_t chunk) {
                     const std::size_t end = std::min(count, (chunk + 1) * kChunk);
                     for (std::size_t i = chunk * kChunk; i < end; ++i)
                         boxes[i] = box_of(i);
                 });
    if (options.stop.stop_requested()) throw Cancelled();
    tree.bvh = widen(build_bvh(boxes, options.threads, options.stop));
    return tree;
}

template <typename BoxOf>
std::shared_ptr<const PrimitiveTree> find_or_build(const TreeList* known,
                                                   const std::array<const void*, 2>& arrays,
                                                   std::size_t count, const BuildOptions& options,
                                                   const BoxOf& box_of) {
    if (known != nullptr) {
        const auto found = std::find_if(known->begin(), known->end(), [&](const auto& tree) {
            return tree->arrays == arrays && tree->count == count;
        });
        if (found != known->end()) return *found;
    }
    return std::make_shared<const PrimitiveTree>(build_tree(arrays, count, options, box_of));
}

}  // namespace

SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse) {
    SceneTrees trees;
    for (const Mesh& mesh : scene.meshes) {
        trees.meshes.push_back(find_or_build(reuse != nullptr ? &reuse->meshes : nullptr,
                                             {mesh.positions.data(), mesh.triangles.data()},
                                             mesh.triangles.size(), options,
                                             [&](std::size_t i) { return triangle_box(mesh, i); }));
    }
    for (const SphereSet& set : scene.sphere_sets) {
        trees.sphere_sets.push_back(find_or_build(
            reuse != nullptr ? &reuse->sphere_sets : nullptr, {set.spheres.data(), nullptr},
            set.spheres.size(), options, [&](std::size_t i) { return sphere_box(set, i); }));
    }
    for (const ConeSet& set : scene.cone_sets) {
        trees.cone_sets.push_back(find_or_build(reuse != nullptr ? &reuse->cone_sets : nullptr,
                                                {set.ends.data(), nullptr}, set.size(), options,
                                                [&](std::size_t i) { return cone_box(set, i); }));
    }
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
