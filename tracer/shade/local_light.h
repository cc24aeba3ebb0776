// Local lighting: what one light adds at a surface.
//
// The GLSL twins are in shaders/local_light.glsl.
#pragma once

#include "tracer/shade/textured.h"

#include <glm/vec3.hpp>

namespace raypick {

// Diffuse and specular terms for a light of colour 1, by the material's model; 0 if it shines from
// behind. All directions are unit; `normal` is the shading normal on the eye's side.
glm::vec3 local_light(const SurfaceMaterial& material, const glm::vec3& normal,
                      const glm::vec3& to_light, const glm::vec3& to_eye);

// The models that it chooses from, with the same arguments.
glm::vec3 phong(const SurfaceMaterial& material, const glm::vec3& normal, const glm::vec3& to_light,
                const glm::vec3& to_eye);
// Source: Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
glm::vec3 blinn_phong(const SurfaceMaterial& material, const glm::vec3& normal,
                      const glm::vec3& to_light, const glm::vec3& to_eye);

}  // namespace raypick
