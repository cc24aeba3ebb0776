// The form of a tree that rays run on: nodes of eight children, whose boxes are tested at once.
//
// Sources: Wald, Benthin, Boulos, "Getting Rid of Packets: Efficient SIMD Single-Ray Traversal
// using Multi-branching BVHs", 2008; Fuetterling et al., "Accelerated Single Ray Tracing for Wide
// Vector Units", 2017 (children ordered by octant beforehand).
#pragma once

#include "tracer/bvh/bvh.h"
#include "tracer/parallel/large_array.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stop_token>

namespace raypick {

inline constexpr std::uint32_t kWidth = 8;

// A place in a tree: a node, or a leaf.
struct WideRef {
    static constexpr std::uint32_t kLeaf = 1u << 31;
    static constexpr std::uint32_t kNothing = ~0u;

    std::uint32_t bits = kNothing;

    static WideRef node(std::uint32_t index) { return {index}; }
    static WideRef leaf(std::uint32_t first) { return {first | kLeaf}; }
    [[nodiscard]] bool is_leaf() const { return (bits & kLeaf) != 0; }
    // Of a node, or of a leaf's first index.
    [[nodiscard]] std::uint32_t index() const { return bits & ~kLeaf; }

    friend bool operator==(const WideRef&, const WideRef&) = default;
};

// Box i reaches from planes[axis][i] to planes[3 + axis][i]. Where there is no child it is empty,
// so that every ray misses it.
struct alignas(64) WideNode {
    std::array<std::array<float, kWidth>, 6> planes{};
    std::array<std::uint32_t, kWidth> child{};  // as in WideRef
    // For each octant of directions (bit `axis` set: negative there) the children from far to near,
    // three bits each. The last one may be read as four bytes, too.
    std::array<std::uint8_t, 32> order{};

    [[nodiscard]] Bounds box(std::uint32_t i) const;
    [[nodiscard]] WideRef ref(std::uint32_t i) const { return {child[i]}; }
    [[nodiscard]] std::uint32_t far_to_near(std::size_t octant) const {
        std::uint32_t children = 0;
        std::memcpy(&children, order.data() + 3 * octant, sizeof children);
        return children;
    }
    void sort_children();  // sets `order`
};

struct WideBvh {
    // Entries of a traversal's stack: seven siblings wait at each level; all eight are written.
    static constexpr std::size_t kMostWaiting = (kWidth - 1) * Bvh::kMaxDepth + 1 + kWidth;
    // Of an index: the last one of its leaf.
    static constexpr std::uint32_t kLast = 1u << 31;

    LargeArray<WideNode> nodes;
    LargeArray<std::uint32_t> indices;
    WideRef root;
    Bounds bounds;  // empty if there is nothing in the tree

    [[nodiscard]] bool empty() const { return bounds.empty(); }
    [[nodiscard]] std::uint64_t bytes() const {
        return nodes.size() * sizeof(WideNode) + indices.size() * sizeof(std::uint32_t);
    }
};

// A leaf's indices as they are stored.
inline std::span<const std::uint32_t> indices_of(const WideBvh& bvh, const WideRef& leaf) {
    const std::uint32_t* first = bvh.indices.data() + leaf.index();
    std::size_t count = 1;
    while ((first[count - 1] & WideBvh::kLast) == 0)
        ++count;
    return {first, count};
}

// Calls body(index) for a leaf's indices until it returns true, and returns whether it did.
template <typename Body>
bool each_index(const WideBvh& bvh, const WideRef& leaf, const Body& body) {
    const std::uint32_t* index = bvh.indices.data() + leaf.index();
    while (true) {
        if (body(*index & ~WideBvh::kLast)) return true;
        if ((*index++ & WideBvh::kLast) != 0) return false;
    }
}

// Takes up to eight descendants of a binary node into one, those of the largest surface first. The
// same for any number of threads. For less than 2^31 boxes; throws std::length_error otherwise, and
// Cancelled.
WideBvh widen(Bvh&& bvh, int threads = 1, const std::stop_token& stop = {});

}  // namespace raypick
