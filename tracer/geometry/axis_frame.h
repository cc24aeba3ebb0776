// The frame in which the angles of disks, cones and tori are measured.
#pragma once

#include "tracer/geometry/absolute.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <numbers>

namespace raypick {

// Right-handed, unit length; y runs along the axis. For the axis +y these are the coordinate axes.
struct AxisFrame {
    glm::dvec3 x{1.0, 0.0, 0.0};
    glm::dvec3 y{0.0, 1.0, 0.0};
    glm::dvec3 z{0.0, 0.0, 1.0};

    [[nodiscard]] glm::dvec3 from_object(const glm::dvec3& v) const {
        return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
    }
    [[nodiscard]] glm::dvec3 to_object(const glm::dvec3& v) const {
        return v.x * x + v.y * y + v.z * z;
    }
};

// x is the coordinate axis that is least parallel to `axis` (of equals the first), made
// perpendicular to it. `axis` has any length but 0.
inline AxisFrame axis_frame(const glm::dvec3& axis) {
    AxisFrame frame;
    frame.y = glm::normalize(axis);
    const glm::dvec3 a = absolute(frame.y);
    glm::dvec3 least{0.0, 0.0, 1.0};
    if (a.x <= a.y && a.x <= a.z) {
        least = {1.0, 0.0, 0.0};
    } else if (a.y <= a.z) {
        least = {0.0, 1.0, 0.0};
    }
    frame.x = glm::normalize(least - glm::dot(least, frame.y) * frame.y);
    frame.z = glm::cross(frame.x, frame.y);
    return frame;
}

// The angle from x over z, as a share of the full turn: in [0, 1].
inline double turn(double x, double z) {
    const double turns = std::atan2(z, x) / (2.0 * std::numbers::pi);
    return turns < 0.0 ? turns + 1.0 : turns;
}

}  // namespace raypick
