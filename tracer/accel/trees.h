// The trees over the primitives of meshes and sets, built once and shared.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/triangle_patches.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace raypick {

// A tree, and the arrays that it was built over: an Accel of an edited scene takes over the trees
// whose arrays it still uses.
struct PrimitiveTree {
    std::array<const void*, 2> arrays{};
    std::size_t count = 0;  // of primitives
    TreeQuality quality = TreeQuality::many_rays;
    WideBvh bvh;
    TrianglePatches patches;  // of a mesh
    float reach = 0.0f;       // the largest coordinate

    [[nodiscard]] std::uint64_t bytes() const { return bvh.bytes() + patches.bytes(); }
};

using TreeList = std::vector<std::shared_ptr<const PrimitiveTree>>;

// One tree a mesh and a set, in the scene's order.
struct SceneTrees {
    TreeList meshes;
    TreeList sphere_sets;
    TreeList cone_sets;
};

// Takes from `reuse` what fits, if it isn't null. Throws Cancelled.
SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse);

// The tree that a shape's rays go down; nullptr for a shape without primitives of its own.
const PrimitiveTree* tree_of(const SceneTrees& trees, const Shape& shape);

}  // namespace raypick
