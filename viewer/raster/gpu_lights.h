// The lights of a view on the GPU.
#pragma once

#include "tracer/scene/light.h"
#include "viewer/gl/textures.h"

#include <glm/vec3.hpp>

#include <vector>

namespace raypick {

// Five texels a light, read by shaders/lights.glsl:
//   0: position relative to the eye (directional: unit direction to the light; rectangle: centre);
//      kind, the index of Light's alternative
//   1: colour; samples a side of an area light
//   2: attenuation (constant, linear, quadratic); radius of a sphere light
//   3: spot: unit direction; cosine of the outer angle. Rectangle: edge_u
//   4: spot: three unused; cosine of the inner angle. Rectangle: edge_v
struct GpuLights {
    BufferTexture texels;
    int count = 0;
    bool shaped = false;  // some are neither points nor directional
};
GpuLights upload_lights(const std::vector<Light>& lights, const glm::dvec3& eye);

}  // namespace raypick
