// Some of a leaf's elements of sets as float bounds look at them: rows of numbers.
#pragma once

#include "tracer/bvh/wide_bvh.h"
#include "tracer/scene/scene.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace raypick {

// A sphere has one row, a cone two, one after the other: see SphereSet and ConeSet.
inline constexpr std::size_t kSphereRows = 1;
inline constexpr std::size_t kConeRows = 2;

// Of one set, by their numbers as the leaf has them.
struct SetElements {
    const glm::vec4* rows;
    std::size_t stride;
    std::span<const std::uint32_t> numbers;
    bool capped = false;  // cones

    [[nodiscard]] std::size_t size() const { return numbers.size(); }
    [[nodiscard]] const glm::vec4* row(std::size_t i) const {
        return rows + stride * (numbers[i] & ~WideBvh::kLast);
    }
};

inline SetElements elements_of(const SphereSet& set, std::span<const std::uint32_t> numbers) {
    return {set.spheres.data(), kSphereRows, numbers};
}
inline SetElements elements_of(const ConeSet& set, std::span<const std::uint32_t> numbers) {
    return {set.ends.data(), kConeRows, numbers, set.capped};
}

// Of several sets, one after the other as the leaf has them: see JoinedElements.
struct LeafElements {
    const glm::vec4* rows;
    std::size_t stride;
    std::size_t count;
    bool capped = false;  // cones

    [[nodiscard]] std::size_t size() const { return count; }
    [[nodiscard]] const glm::vec4* row(std::size_t i) const { return rows + stride * i; }
};

}  // namespace raypick
