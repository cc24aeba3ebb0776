// What goes into tracing and what comes out.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace raypick {

// An eye ray with what it stands for.
struct EyeRay {
    Ray ray;
    RayCone cone;            // for texture filtering
    std::uint64_t seed = 0;  // of all that is random on its way (points on area lights)
};

// One traced eye ray: the colour and, for the frame's other channels, what was hit first.
struct TracedRay {
    glm::vec3 colour{0.0f};  // linear RGB
    Hit hit;                 // invalid: background; uv may be 0 where no material has maps
    glm::vec3 normal{0.0f};  // shading normal towards the eye, scene space; 0 on a miss
};

}  // namespace raypick
