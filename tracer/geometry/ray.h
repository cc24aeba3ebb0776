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

// What a pixel's ray stands for: a cone of this diameter around it, width + spread * t at t.
// Source: Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing",
// Ray Tracing Gems, 2019.
struct RayCone {
    float width = 0.0f;   // at the origin
    float spread = 0.0f;  // growth per unit of t

    [[nodiscard]] float at(float t) const { return width + spread * t; }
};

}  // namespace raypick
