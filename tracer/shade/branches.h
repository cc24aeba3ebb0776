// Where the light at a surface comes from, apart from the lights: the rays that it sends on.
#pragma once

#include "tracer/shade/boundary.h"
#include "tracer/shade/random.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// Also what a ray's seed is derived by: randomness depends on the way to a point, not on which rays
// were followed before.
enum class BranchKind : std::uint64_t {
    transmitted,  // refracted
    mirrored,
    straight,  // through what is not opaque, as if nothing was there
};

// One ray that leaves a surface.
struct Branch {
    BranchKind kind = BranchKind::mirrored;
    glm::vec3 direction{0.0f};
    glm::vec3 share{0.0f};  // of what comes along it, in the surface's colour
    float weight = 0.0f;    // the most that it can add to its pixel
};

// At most one of each kind.
struct Branches {
    std::array<Branch, 3> branch;
    std::size_t count = 0;
};

// The rays from a point where a ray arrived that can add `weight` to its pixel; not those below the
// settings' cutoff.
void find_branches(const ShadeScene& scene, const ShadingPoint& point, const Boundary& boundary,
                   float weight, Branches& found);

inline float largest(const glm::vec3& v) {
    return std::max(std::max(v.x, v.y), v.z);
}

// The seed of a ray that leaves where one with `seed` arrived, and of the points on a light.
std::uint64_t branch_seed(const ShadeScene& scene, std::uint64_t seed, BranchKind kind);
inline std::uint64_t light_seed(const ShadeScene& scene, std::uint64_t seed, std::size_t light) {
    constexpr std::uint64_t kFirstLight = 3;  // after the kinds of branches
    if (scene.lights[light].side == 1) return seed;
    return RandomSequence::derive(seed, kFirstLight + light);
}

}  // namespace raypick
