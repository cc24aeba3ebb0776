// A bounding volume hierarchy over boxes: it knows boxes and indices, nothing else.
//
// Source: binned surface area heuristic after Wald, "On fast Construction of SAH-based Bounding
// Volume Hierarchies", 2007.
#pragma once

#include "tracer/geometry/bounds.h"

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// An inner node has its children at `first` and `first` + 1; a leaf holds
// indices[first .. first + count).
struct BvhNode {
    Bounds bounds;
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: inner node

    [[nodiscard]] bool is_leaf() const { return count > 0; }
};

struct Bvh {
    static constexpr int kMaxDepth = 64;

    std::vector<BvhNode> nodes;          // nodes[0] is the root; empty if there are no boxes
    std::vector<std::uint32_t> indices;  // of the boxes given to build_bvh

    [[nodiscard]] std::uint64_t bytes() const {
        return nodes.size() * sizeof(BvhNode) + indices.size() * sizeof(std::uint32_t);
    }
};

// Boxes that are empty or not finite are left out. The tree is the same for any number of threads
// and at most kMaxDepth deep. Throws Cancelled.
Bvh build_bvh(std::span<const Bounds> boxes, int threads, const std::stop_token& stop);

}  // namespace raypick
