// Boxes to build trees over, and trees over them.
#pragma once

#include "tests/binary_form.h"
#include "tests/random.h"
#include "tracer/bvh/bvh.h"
#include "tracer/bvh/bvh_fast.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

using Boxes = std::vector<Bounds>;

inline BoxSource source_of(const Boxes& boxes) {
    return [&boxes](std::size_t first, std::span<Bounds> wanted) {
        std::copy_n(boxes.begin() + static_cast<std::ptrdiff_t>(first), wanted.size(),
                    wanted.begin());
    };
}

// Boxes about as large as their distances, in a cube.
inline Boxes scattered(std::uint64_t seed, std::size_t count, double size) {
    Random random(seed);
    Boxes boxes(count);
    for (Bounds& box : boxes) {
        const glm::dvec3 centre = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        box.extend(glm::vec3(centre + size * random.point(glm::dvec3(-1.0), glm::dvec3(1.0))));
        box.extend(glm::vec3(centre + size * random.point(glm::dvec3(-1.0), glm::dvec3(1.0))));
    }
    return boxes;
}

// Few large boxes among many small ones in clusters, as a building's model has.
inline Boxes clustered(std::uint64_t seed, std::size_t count) {
    Random random(seed);
    Boxes boxes;
    glm::dvec3 centre(0.0);
    while (boxes.size() < count) {
        if (boxes.size() % 100 == 0) {
            centre = random.point({-10.0, -2.0, -5.0}, {10.0, 2.0, 5.0});
        }
        const double size = random.below(50) == 0 ? 3.0 : 0.02;
        Bounds box;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 off = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
            box.extend(glm::vec3(centre + 0.3 * random.unit() * glm::dvec3(1.0) + size * off));
        }
        boxes.push_back(box);
    }
    return boxes;
}

// The first tree, as if it were binary.
inline Bvh build_first(std::size_t count, const BoxSource& boxes, const BvhOptions& options) {
    return BinaryForm::of(build_bvh_fast(count, boxes, options));
}

}  // namespace raypick
