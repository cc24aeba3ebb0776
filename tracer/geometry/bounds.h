// Axis-aligned bounding boxes.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <limits>

namespace raypick {

// The default is empty: extending it by a point gives that point.
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool empty() const {
        return !(min.x <= max.x && min.y <= max.y && min.z <= max.z);
    }
    [[nodiscard]] glm::vec3 centre() const { return 0.5f * min + 0.5f * max; }
    [[nodiscard]] glm::vec3 extent() const { return max - min; }
    [[nodiscard]] float half_area() const {
        const glm::vec3 e = extent();
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    void extend(const glm::vec3& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void extend(const Bounds& b) {
        min = glm::min(min, b.min);
        max = glm::max(max, b.max);
    }
};

}  // namespace raypick
