// Light sources. Colours are linear RGB and may exceed 1; no fall-off with distance.
#pragma once

#include "tracer/geometry/camera.h"

#include <glm/vec3.hpp>

#include <string>
#include <variant>

namespace raypick {

struct PointLight {
    std::string name;
    glm::dvec3 position{0.0};  // scene space
    glm::vec3 colour{1.0f};
};

struct DirectionalLight {
    std::string name;
    glm::dvec3 direction{0.0, -1.0, 0.0};  // the way the light travels, any length but 0
    glm::vec3 colour{1.0f};
};

using Light = std::variant<PointLight, DirectionalLight>;

// What a scene without lights is seen by: a lamp at the camera's eye.
PointLight headlight(const Camera& camera);

}  // namespace raypick
