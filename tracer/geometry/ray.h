// A ray: the open set { origin + t direction : t_min < t < t_max }.
#pragma once

#include <glm/vec3.hpp>

#include <limits>

namespace raypick {

// World rays have unit direction, so that t is a distance in world units.
struct Ray {
    glm::vec3 origin{0.0f};
    glm::vec3 direction{0.0f, 0.0f, -1.0f};
    float t_min = 0.0f;
    float t_max = std::numeric_limits<float>::infinity();

    [[nodiscard]] glm::vec3 at(float t) const { return origin + t * direction; }
};

}  // namespace raypick
