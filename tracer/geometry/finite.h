// Whether numbers are neither infinite nor NaN.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>

namespace raypick {

inline bool all_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace raypick
