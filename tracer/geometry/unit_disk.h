// The unit disk, for whoever spreads points over one: a lens, a light.
#pragma once

#include <glm/vec2.hpp>

#include <cmath>
#include <numbers>

namespace raypick {

// Maps the unit square to the unit disk, the middle to the centre, equal areas to equal areas.
// Source: Shirley, Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
inline glm::dvec2 disk_from_square(const glm::dvec2& square) {
    const glm::dvec2 p = 2.0 * square - 1.0;
    if (p == glm::dvec2(0.0)) return p;
    const bool across = std::abs(p.x) > std::abs(p.y);
    const double radius = across ? p.x : p.y;
    const double angle = across ? std::numbers::pi / 4 * (p.y / p.x)
                                : std::numbers::pi / 2 - std::numbers::pi / 4 * (p.x / p.y);
    return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

}  // namespace raypick
