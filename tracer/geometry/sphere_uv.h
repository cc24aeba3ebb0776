// The uv of a sphere.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raypick {

// Longitude from +x over +z in [0, 1), colatitude from +y in [0, 1].
inline glm::dvec2 sphere_uv(const glm::dvec3& unit_normal) {
    const double longitude = std::atan2(unit_normal.z, unit_normal.x) / (2.0 * std::numbers::pi);
    const double colatitude = std::acos(std::clamp(unit_normal.y, -1.0, 1.0)) / std::numbers::pi;
    return {longitude < 0.0 ? longitude + 1.0 : longitude, colatitude};
}

}  // namespace raypick
