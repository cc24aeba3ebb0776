// Seeded random numbers, the same with every standard library.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <random>

namespace raypick {

class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}

    // In [0, 1).
    double unit() { return static_cast<double>(bits_() >> 11u) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    std::uint32_t below(std::size_t count) {
        return static_cast<std::uint32_t>(unit() * static_cast<double>(count));
    }
    glm::dvec3 point(const glm::dvec3& min, const glm::dvec3& max) {
        const double x = between(min.x, max.x);
        const double y = between(min.y, max.y);
        return {x, y, between(min.z, max.z)};
    }
    // Unit length, every direction equally likely.
    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 p = point(glm::dvec3(-1.0), glm::dvec3(1.0));
            const double length = glm::length(p);
            if (length > 0.01 && length <= 1.0) return p / length;
        }
    }

private:
    std::mt19937_64 bits_;
};

}  // namespace raypick
