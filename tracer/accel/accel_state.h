// What an Accel holds: the scene, its trees, and the tree over its objects.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/accel/trees.h"
#include "tracer/bvh/wide_bvh.h"
#include "tracer/geometry/transform.h"
#include "tracer/scene/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace raypick {

struct Instance;

// Whose primitives a joined tree holds (see trees.h).
struct Member {
    std::uint32_t object = kNobody;  // index; none: they are there no more
    const Instance* instance = nullptr;
};

// An object as rays meet it, or the objects that share a joined tree.
struct Instance {
    Transform object_from_world;
    bool identity = true;
    bool holes = false;  // it may be cut out
    float slop = 0.0f;   // how far rounding may have moved a ray in object space, per unit
    const PrimitiveTree* tree = nullptr;
    std::span<const Member> members{};  // of a joined tree; else empty

    [[nodiscard]] bool joined() const { return !members.empty(); }
};

// What the top tree's leaves hold: an object, or a part of what has a tree.
struct TopEntry {
    std::uint32_t object = 0;  // index of the instance
    WideRef part;

    friend bool operator==(const TopEntry&, const TopEntry&) = default;
};

struct AccelState {
    std::shared_ptr<const Scene> scene;
    SceneTrees trees;
    std::vector<Instance> instances;   // one an object, and one of each joined tree
    std::vector<Member> mesh_members;  // of the joined trees
    std::vector<Member> set_members;
    std::vector<TopEntry> entries;         // of the finite objects
    WideBvh top;                           // over the entries
    std::vector<std::uint32_t> unbounded;  // infinite planes
    Bounds bounds;                         // of the finite objects
    float reach = 0.0f;                    // the largest coordinate of these
    bool mostly_triangles = false;         // more of them than spheres and cones of sets
    bool has_spheres = false;              // in sets
};

}  // namespace raypick
