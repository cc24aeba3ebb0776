// From double to float, away from the inside.
#pragma once

#include "tracer/geometry/absolute.h"
#include "tracer/geometry/bounds.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <limits>

namespace raypick {

inline float round_down(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity())
                                      : f;
}

inline float round_up(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity())
                                      : f;
}

// A box in float that holds the one in double, whose corners were rounded (to double) themselves.
inline Bounds rounded_outwards(const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 slack = 1e-15 * glm::max(absolute(low), absolute(high));
    Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        bounds.min[axis] = round_down(low[axis] - slack[axis]);
        bounds.max[axis] = round_up(high[axis] + slack[axis]);
    }
    return bounds;
}

}  // namespace raypick
