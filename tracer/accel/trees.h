// The trees over the primitives of meshes and sets, built once and shared.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/joined_tree.h"
#include "tracer/accel/triangle_patches.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/scene/scene.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace raypick {

// A tree, and the arrays that it was built over: an Accel of an edited scene takes over the trees
// whose arrays it still uses.
struct PrimitiveTree {
    TreeArrays arrays{};
    std::size_t count = 0;  // of primitives
    TreeQuality quality = TreeQuality::many_rays;
    WideBvh bvh;
    TrianglePatches patches;  // of a mesh
    float reach = 0.0f;       // the largest coordinate

    [[nodiscard]] std::uint64_t bytes() const { return bvh.bytes() + patches.bytes(); }
};

using TreeList = std::vector<std::shared_ptr<const PrimitiveTree>>;

// One tree for several meshes, which stays as it is when some of them are moved elsewhere.
struct JoinedTree {
    std::vector<TreeArrays> members;
    std::vector<Bounds> bounds;  // of each member
    PrimitiveTree tree;
};

// One tree a mesh and a set, in the scene's order; none for a mesh that stands in the joined tree
// only.
struct SceneTrees {
    TreeList meshes;
    TreeList sphere_sets;
    TreeList cone_sets;
    std::shared_ptr<const JoinedTree> joined;   // null: there is none
    std::vector<std::uint32_t> joined_objects;  // see objects_of_members
};

// Takes from `reuse` what fits, if it isn't null. Meshes are joined for many rays only. Throws
// Cancelled.
SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse);

// The tree that a shape's rays go down; nullptr for a shape without primitives of its own, or whose
// mesh stands in the joined tree only.
const PrimitiveTree* tree_of(const SceneTrees& trees, const Shape& shape);

}  // namespace raypick
