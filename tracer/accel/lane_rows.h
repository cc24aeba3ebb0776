// Numbers of many things side by side: a row for each number, a lane for each thing.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>

namespace raypick {

// Into and out of three rows from `row` on. `lane` is the thing's place in row 0, `Lanes` how far
// apart rows are.
template <std::size_t Lanes, typename T>
void put_vector(T* lane, std::size_t row, const glm::vec<3, T>& v) {
    lane[row * Lanes] = v.x;
    lane[(row + 1) * Lanes] = v.y;
    lane[(row + 2) * Lanes] = v.z;
}
template <std::size_t Lanes, typename T>
glm::vec<3, T> vector_at(const T* lane, std::size_t row) {
    return {lane[row * Lanes], lane[(row + 1) * Lanes], lane[(row + 2) * Lanes]};
}

}  // namespace raypick
