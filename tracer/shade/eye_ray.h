// What goes into tracing and what comes out.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"
#include "tracer/parallel/large_array.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// An eye ray with what it stands for.
struct EyeRay {
    Ray ray;
    RayCone cone;            // for texture filtering
    std::uint64_t seed = 0;  // of all that is random on its way (points on area lights)
};

// Many of them, which have one cone.
struct EyeRays {
    std::span<const Ray> rays;
    RayCone cone;
    std::span<const std::uint64_t> seeds;  // as many; or empty: all are 0

    [[nodiscard]] std::size_t size() const { return rays.size(); }
    [[nodiscard]] std::uint64_t seed(std::size_t i) const { return seeds.empty() ? 0 : seeds[i]; }
};

// The same with memory of its own, which is not cleared.
struct EyeRayList {
    LargeArray<Ray> rays;
    RayCone cone;
    std::vector<std::uint64_t> seeds;

    // Eye rays are added with a seed each, or not at all.
    void add(const EyeRay& eye) {
        rays.push_back(eye.ray);
        seeds.push_back(eye.seed);
        cone = eye.cone;
    }
    [[nodiscard]] EyeRays all() const { return {rays, cone, seeds}; }
};

// One traced eye ray: the colour and, for the frame's other channels, what was hit first.
struct TracedRay {
    glm::vec3 colour{0.0f};  // linear RGB
    Hit hit;                 // invalid: background; uv may be 0 where no material has maps
    glm::vec3 normal{0.0f};  // shading normal towards the eye, scene space; 0 on a miss
};

// Many of them; of some nobody looks at more than the colour.
struct TracedRays {
    LargeArray<glm::vec3> colours;
    LargeArray<Hit> hits;  // as many, or none
    LargeArray<glm::vec3> normals;

    // All of which is to be set.
    TracedRays(std::size_t count, bool with_hits) : colours(count) {
        if (!with_hits) return;
        hits.resize(count);
        normals.resize(count);
    }
    [[nodiscard]] bool has_hits() const { return !hits.empty(); }
};

}  // namespace raypick
