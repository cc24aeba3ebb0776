// Which meshes of a scene share one tree. Meshes that stand where they are and nowhere else, such
// as those that a file cuts a building into by material, lie in each other's way: a tree over the
// triangles of all of them knows which are near each other, trees of their own don't.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/joined_meshes.h"
#include "tracer/geometry/bounds.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace raypick {

// The arrays that a tree is built over.
using TreeArrays = std::array<const void*, 2>;

inline TreeArrays arrays_of(const Mesh& mesh) {
    return {mesh.positions.data(), mesh.triangles.data()};
}

inline constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

// By mesh: how many objects have it.
std::vector<std::uint32_t> count_uses(const Scene& scene);

struct JoinableMesh {
    const Mesh* mesh = nullptr;
    Bounds bounds;
};

// The meshes to be joined, in the order of their objects: those that stand where they are and
// nowhere else, if they are in each other's way, else none.
std::vector<JoinableMesh> joinable_meshes(const Scene& scene, const BuildOptions& options);

// For each member the index of the object that it is the mesh of, where it stands as it is:
// kNobody for one that has been moved since, or is gone.
std::vector<std::uint32_t> objects_of_members(const Scene& scene,
                                              const std::vector<TreeArrays>& members);

}  // namespace raypick
