#include "tracer/shade/local_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

// GLSL leaves pow(0, 0) undefined, so both sides take 0 where the eye is not in the lobe. A cosine
// rounded to more than 1 would grow beyond bounds.
float highlight(float lobe, float shininess) {
    return lobe > 0.0f ? std::pow(std::min(lobe, 1.0f), shininess) : 0.0f;
}

}  // namespace

glm::vec3 local_light(const SurfaceMaterial& material, const glm::vec3& normal,
                      const glm::vec3& to_light, const glm::vec3& to_eye) {
    return material.model == LocalModel::phong ? phong(material, normal, to_light, to_eye)
                                               : blinn_phong(material, normal, to_light, to_eye);
}

glm::vec3 phong(const SurfaceMaterial& material, const glm::vec3& normal, const glm::vec3& to_light,
                const glm::vec3& to_eye) {
    const float diffuse = glm::dot(normal, to_light);
    if (!(diffuse > 0.0f)) return glm::vec3(0.0f);
    const glm::vec3 mirrored = 2.0f * diffuse * normal - to_light;
    return material.diffuse * diffuse +
           material.specular * highlight(glm::dot(mirrored, to_eye), material.shininess);
}

glm::vec3 blinn_phong(const SurfaceMaterial& material, const glm::vec3& normal,
                      const glm::vec3& to_light, const glm::vec3& to_eye) {
    const float diffuse = glm::dot(normal, to_light);
    if (!(diffuse > 0.0f)) return glm::vec3(0.0f);
    // Looking straight into the light from behind the surface, there is no half-way direction.
    const glm::vec3 sum = to_light + to_eye;
    const float length = glm::length(sum);
    const float lobe = length > 0.0f ? glm::dot(normal, sum) / length : 0.0f;
    return material.diffuse * diffuse + material.specular * highlight(lobe, material.shininess);
}

}  // namespace raypick
