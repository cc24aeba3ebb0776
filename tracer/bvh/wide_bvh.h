// The form of a tree that rays run on: nodes of eight children, whose boxes are tested at once.
//
// Source: Wald, Benthin, Boulos, "Getting Rid of Packets: Efficient SIMD Single-Ray Traversal using
// Multi-branching BVHs", 2008.
#pragma once

#include "tracer/bvh/bvh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace raypick {

inline constexpr std::uint32_t kWidth = 8;

// Box i reaches from planes[axis][i] to planes[3 + axis][i]. Where there is no child it is empty,
// so that every ray misses it.
struct alignas(64) WideNode {
    std::array<std::array<float, kWidth>, 6> planes{};
    // Of an inner child: its node. Of a leaf: the first of its `count` indices.
    std::array<std::uint32_t, kWidth> child{};
    std::array<std::uint8_t, kWidth> count{};  // 0: inner
    std::uint32_t children = 0;                // the first ones are there

    [[nodiscard]] Bounds box(std::uint32_t i) const;
};

// A place in a tree: a node, or a leaf's indices.
struct WideRef {
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: node `first`; else indices [first, first + count)
};

struct WideBvh {
    static constexpr std::uint32_t kLargestLeaf = 255;
    // Entries of a traversal's stack: seven siblings wait at each level.
    static constexpr std::size_t kMostWaiting = (kWidth - 1) * Bvh::kMaxDepth + 1;

    std::vector<WideNode> nodes;
    std::vector<std::uint32_t> indices;
    WideRef root;
    Bounds bounds;  // empty if there is nothing in the tree

    [[nodiscard]] bool empty() const { return bounds.empty(); }
    [[nodiscard]] std::uint64_t bytes() const {
        return nodes.size() * sizeof(WideNode) + indices.size() * sizeof(std::uint32_t);
    }
};

// Takes up to eight descendants of a binary node into one, those of the largest surface first.
WideBvh widen(Bvh&& bvh);

}  // namespace raypick
