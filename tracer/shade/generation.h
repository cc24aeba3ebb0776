// Rays that are followed together.
#pragma once

#include "tracer/geometry/ray.h"
#include "tracer/parallel/large_array.h"
#include "tracer/shade/branches.h"
#include "tracer/shade/interior.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace raypick {

inline constexpr std::uint32_t kNoInterior = 0xffffffffu;  // outside of everything

// What comes along a ray: passed * colour. A cache line, so that none is fetched in vain.
struct alignas(64) RayPath {
    glm::vec3 share{1.0f};     // of what comes along it, in the colour at its parent's end
    std::uint32_t parent = 0;  // the path at whose end it begins; an eye ray's number
    RayCone cone;              // at its origin, then at its end
    float weight = 1.0f;       // the most that it can add to its pixel
    std::uint32_t interior = kNoInterior;
    std::uint64_t seed = 0;  // of what is random at its end
    glm::vec3 passed{1.0f};  // what absorption leaves on its way
    glm::vec3 colour{0.0f};  // that leaves its end
};
static_assert(sizeof(RayPath) == 64);

// All rays of one depth that are there at a time, in the order in which they left. Keeps its
// memory.
struct Generation {
    LargeArray<RayPath> paths;
    LargeArray<Ray> rays;                 // empty for eye rays, which have theirs already
    LargeArray<std::uint8_t> directions;  // as from direction_group(); likewise
    std::vector<Interior> interiors;      // of those inside of something
    std::vector<std::uint32_t> order;     // in which they are followed

    [[nodiscard]] const Interior* interior_of(const RayPath& path) const {
        return path.interior == kNoInterior ? nullptr : &interiors[path.interior];
    }
    void clear();
    // So many rays more, all of which is to be set: clearing it takes its time.
    void add(std::size_t count);
    void put_inside(RayPath& path, const Interior& interior);

    // Sets `order`: as they came,
    void keep_order();
    // or those of one direction group after the other.
    void order_by_direction();
};

inline constexpr std::size_t kOctants = 8;
inline constexpr std::size_t kDirections = 3 * kOctants;

// Rays of one kind and octant travel together. Returns a number below kDirections.
inline std::uint8_t direction_group(BranchKind kind, const glm::vec3& direction) {
    const unsigned octant = (direction.x < 0.0f ? 1u : 0u) | (direction.y < 0.0f ? 2u : 0u) |
                            (direction.z < 0.0f ? 4u : 0u);
    return static_cast<std::uint8_t>(kOctants * static_cast<std::size_t>(kind) + octant);
}

}  // namespace raypick
