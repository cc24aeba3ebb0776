// Absolute values of a vector's components.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace raypick {

// glm::abs with an instruction a component instead of a branch, which can't be foretold for
// coordinates and normals.
template <glm::length_t Size, typename Number>
glm::vec<Size, Number> absolute(const glm::vec<Size, Number>& v) {
    glm::vec<Size, Number> result;
    for (glm::length_t i = 0; i < Size; ++i)
        result[i] = std::abs(v[i]);
    return result;
}

}  // namespace raypick
