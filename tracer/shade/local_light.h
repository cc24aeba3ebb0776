// Local lighting: what one light adds at a surface.
//
// The GLSL twins are in shaders/local_light.glsl.
#pragma once

#include "tracer/shade/textured.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

// GLSL leaves pow(0, 0) undefined, so both sides take 0 where the eye is not in the lobe. A cosine
// rounded to more than 1 would grow beyond bounds.
inline float highlight(float lobe, float shininess) {
    return lobe > 0.0f ? std::pow(std::min(lobe, 1.0f), shininess) : 0.0f;
}

// The highlight is worked out only where it is seen.
inline glm::vec3 with_highlight(const glm::vec3& matt, const SurfaceMaterial& material,
                                float lobe) {
    if (material.specular == glm::vec3(0.0f)) return matt;
    return matt + material.specular * highlight(lobe, material.shininess);
}

// The models, with the arguments of local_light.
inline glm::vec3 phong(const SurfaceMaterial& material, const glm::vec3& normal,
                       const glm::vec3& to_light, const glm::vec3& to_eye) {
    const float diffuse = glm::dot(normal, to_light);
    if (!(diffuse > 0.0f)) return glm::vec3(0.0f);
    const glm::vec3 mirrored = 2.0f * diffuse * normal - to_light;
    return with_highlight(material.diffuse * diffuse, material, glm::dot(mirrored, to_eye));
}
// Source: Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
inline glm::vec3 blinn_phong(const SurfaceMaterial& material, const glm::vec3& normal,
                             const glm::vec3& to_light, const glm::vec3& to_eye) {
    const float diffuse = glm::dot(normal, to_light);
    if (!(diffuse > 0.0f)) return glm::vec3(0.0f);
    // Looking straight into the light from behind the surface, there is no half-way direction.
    const glm::vec3 sum = to_light + to_eye;
    const float length = glm::length(sum);
    const float lobe = length > 0.0f ? glm::dot(normal, sum) / length : 0.0f;
    return with_highlight(material.diffuse * diffuse, material, lobe);
}

// Diffuse and specular terms for a light of colour 1, by the material's model; 0 if it shines from
// behind. All directions are unit; `normal` is the shading normal on the eye's side.
inline glm::vec3 local_light(const SurfaceMaterial& material, const glm::vec3& normal,
                             const glm::vec3& to_light, const glm::vec3& to_eye) {
    return material.model == LocalModel::phong ? phong(material, normal, to_light, to_eye)
                                               : blinn_phong(material, normal, to_light, to_eye);
}

}  // namespace raypick
