// The trees over the primitives of meshes and sets, built once and shared.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/joined_sets.h"
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
    JoinedElements elements;  // of joined sets
    float reach = 0.0f;       // the largest coordinate

    [[nodiscard]] std::uint64_t bytes() const {
        return bvh.bytes() + patches.bytes() + elements.bytes();
    }
};

using TreeList = std::vector<std::shared_ptr<const PrimitiveTree>>;

// One tree for several meshes, or sets, which stays as it is when some of them are moved elsewhere.
struct JoinedTree {
    std::vector<JoinedMember> members;
    std::vector<Bounds> bounds;  // of each member
    PrimitiveTree tree;
};

// A joined tree as a scene has it.
struct JoinedInScene {
    std::shared_ptr<const JoinedTree> tree;  // null: there is none
    std::vector<JoinedMember> members;       // as far as they are left
    std::vector<std::uint32_t> objects;      // see objects_of_members
};

// One tree a mesh and a set, in the scene's order; none for what stands in a joined tree only.
struct SceneTrees {
    TreeList meshes;
    TreeList sphere_sets;
    TreeList cone_sets;
    JoinedInScene joined_meshes;
    JoinedInScene joined_sets;
};

// Takes from `reuse` what fits, if it isn't null. Trees are joined for many rays only. Throws
// Cancelled.
SceneTrees build_trees(const Scene& scene, const BuildOptions& options, const SceneTrees* reuse);

// The tree that a shape's rays go down; nullptr for a shape without primitives of its own, or whose
// mesh or set stands in a joined tree only.
const PrimitiveTree* tree_of(const SceneTrees& trees, const Shape& shape);

}  // namespace raypick
