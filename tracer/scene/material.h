// What a surface looks like. Colours are linear RGB.
#pragma once

#include <glm/vec3.hpp>

#include <string>

namespace raypick {

// Phong's model with the notes' recursive terms:
//   colour = emissive + ambient * scene ambient
//          + sum over lights: light * (diffuse * max(0, N.L) + specular * max(0, R.V)^shininess)
//          + reflect * trace(reflection ray) + transmit * trace(refraction ray)
struct Material {
    std::string name;
    glm::vec3 ambient{0.8f};
    glm::vec3 diffuse{0.8f};
    glm::vec3 specular{0.0f};
    float shininess = 32.0f;
    glm::vec3 emissive{0.0f};
    glm::vec3 reflect{0.0f};
    glm::vec3 transmit{0.0f};
    float ior = 1.5f;  // index of refraction of the inside; the outside has 1

    [[nodiscard]] bool reflects() const { return reflect != glm::vec3(0.0f); }
    [[nodiscard]] bool transmits() const { return transmit != glm::vec3(0.0f); }
};

}  // namespace raypick
