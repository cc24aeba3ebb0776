// Which descendants of a binary node to make a wide node's children, so that rays visit few nodes.
//
// Source: Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
// Wide BVHs", 2017 (the dynamic programme of section 3.1, with leaves that stay as they are).
#pragma once

#include "tracer/bvh/bvh.h"
#include "tracer/bvh/wide_nodes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

class BestChildren {
public:
    // For all inner nodes; children stand behind their parents. `per_node` is what a wide node
    // costs beside the rays' visits, in visits of the root. May be called again.
    void find(std::span<const BvhNode> nodes, float per_node);
    // Of an inner node.
    [[nodiscard]] WideChildren of(std::uint32_t root) const;

private:
    // What a subtree costs if it becomes at most n subtrees of a wide node, at place kWidth - 1 +
    // n: before that there is no way.
    using Costs = std::array<float, std::size_t{2} * kWidth>;

    struct Opened {
        std::uint32_t node = 0;
        std::uint32_t most = 0;  // children that it may become
    };
    [[nodiscard]] std::uint32_t share_of_first(const Opened& opened) const;

    std::span<const BvhNode> nodes_;
    std::vector<Costs> costs_;
};

}  // namespace raypick
