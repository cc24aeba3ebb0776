// Materials in code for tests that look at light.
#pragma once

#include "tests/tracer_scenes.h"

namespace raypick {

inline Material matt(const glm::vec3& colour) {
    Material material = black_material();
    material.ambient = colour;
    material.diffuse = colour;
    return material;
}

inline Material shiny(const glm::vec3& colour, float specular, float shininess) {
    Material material = matt(colour);
    material.specular = glm::vec3(specular);
    material.shininess = shininess;
    return material;
}

inline Material mirror(const glm::vec3& reflect, Reflectance reflectance) {
    Material material = black_material();
    material.reflect = reflect;
    material.reflectance = reflectance;
    return material;
}

// All of the light goes one way or the other.
inline Material glass(float ior, Reflectance reflectance) {
    Material material = black_material();
    material.transmit = glm::vec3(1.0f);
    if (reflectance == Reflectance::dielectric) material.reflect = glm::vec3(1.0f);
    material.ior = ior;
    material.reflectance = reflectance;
    return material;
}

}  // namespace raypick
