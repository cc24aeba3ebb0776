// Which meshes of a scene share one tree, and which of its sets share another. What stands where it
// is and nowhere else, such as the meshes that a file cuts a building into by material, or a
// molecule's atoms and bonds, lies in each other's way: a tree over the primitives of all of them
// knows which are near each other, trees of their own don't.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/joined_meshes.h"
#include "tracer/accel/joined_sets.h"
#include "tracer/geometry/bounds.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

namespace raypick {

// The arrays that a tree is built over.
using TreeArrays = std::array<const void*, 2>;

inline TreeArrays arrays_of(const Mesh& mesh) {
    return {mesh.positions.data(), mesh.triangles.data()};
}

inline TreeArrays arrays_of(const SphereSet& set) {
    return {set.spheres.data(), nullptr};
}
inline TreeArrays arrays_of(const ConeSet& set) {
    return {set.ends.data(), nullptr};
}

// A mesh or a set that a joined tree holds. One that is no longer there is nobody's for good: what
// comes to stand in its memory is something else.
struct JoinedMember {
    enum class Kind { gone, mesh, spheres, open_cones, capped_cones };
    Kind kind = Kind::gone;
    TreeArrays arrays{};
    std::size_t primitives = 0;

    friend bool operator<(const JoinedMember& a, const JoinedMember& b) {
        return std::tie(a.kind, a.arrays, a.primitives) < std::tie(b.kind, b.arrays, b.primitives);
    }
};
JoinedMember member_of(const Mesh& mesh);
JoinedMember member_of(const SphereSet& set);
JoinedMember member_of(const ConeSet& set);

inline constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

// How many objects have a mesh or a set, by its number.
struct Uses {
    explicit Uses(const Scene& scene);
    // Of what the shape has; nullptr for a shape that has neither.
    [[nodiscard]] std::uint32_t* of(const Shape& shape);

    std::vector<std::uint32_t> meshes;
    std::vector<std::uint32_t> sphere_sets;
    std::vector<std::uint32_t> cone_sets;
};

struct JoinableMesh {
    const Mesh* mesh = nullptr;
    Bounds bounds;
};

// The meshes to be joined, in the order of their objects: those that stand where they are and
// nowhere else, if they are in each other's way, else none.
std::vector<JoinableMesh> joinable_meshes(const Scene& scene, const BuildOptions& options);

// The sets to be joined, those of spheres first, by the same rule. Of cones capped ones or open
// ones, whichever are more.
std::vector<JoinableSet> joinable_sets(const Scene& scene, const BuildOptions& options);

// For each member the index of the object that it is the mesh or the set of, where it stands as it
// is: kNobody for one that has been moved since, or is gone.
std::vector<std::uint32_t> objects_of_members(const Scene& scene,
                                              const std::vector<JoinedMember>& members);
// The members with those gone that the scene has neither as a mesh nor as a set.
std::vector<JoinedMember> members_left(const Scene& scene, std::vector<JoinedMember> members);

}  // namespace raypick
