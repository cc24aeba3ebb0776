// A bounding volume hierarchy over boxes: it knows boxes and indices, nothing else.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/parallel/large_array.h"

#include <cstddef>
#include <cstdint>
#include <functional>
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

    std::vector<BvhNode> nodes;         // nodes[0] is the root; empty if there are no boxes
    LargeArray<std::uint32_t> indices;  // of the boxes given to build_bvh

    [[nodiscard]] std::uint64_t bytes() const {
        return nodes.size() * sizeof(BvhNode) + indices.size() * sizeof(std::uint32_t);
    }
};

// What rays pay, for the surface area heuristic. A leaf's boxes are tested in blocks, as SIMD does.
struct LeafCosts {
    float node = 1.0f;             // of visiting an inner node, that is two boxes
    float block = 1.0f;            // of testing a block of a leaf's boxes
    std::uint32_t block_size = 1;  // boxes in a block, a power of two
    std::uint32_t min_leaf = 1;    // so few boxes are a leaf in any case
    std::uint32_t max_leaf = 4;    // no leaf holds more
};

// For a tree that is made 8 wide and whose leaves are tested four or eight boxes at once. A wide
// node stands for about three levels of binary ones.
inline constexpr LeafCosts kWideLeaves{
    .node = 0.3f, .block = 1.0f, .block_size = 4, .min_leaf = 1, .max_leaf = 8};

// The same for surfaces: what lies near each other there is near enough for one leaf, and not to
// look whether it is saves an eighth of the time.
inline constexpr LeafCosts kWideSurfaceLeaves{
    .node = 0.3f, .block = 1.0f, .block_size = 8, .min_leaf = 6, .max_leaf = 8};

// For one whose leaves hold spheres and cones: those are tested apart, and of cones that fill
// little of their boxes a box of its own rules out most.
inline constexpr LeafCosts kMixedLeaves{
    .node = 0.3f, .block = 1.0f, .block_size = 1, .min_leaf = 1, .max_leaf = 4};

struct BvhOptions {
    LeafCosts costs;
    int threads = 0;       // 0: all cores. The tree is the same for any number
    std::stop_token stop;  // building then throws Cancelled
};

// Sets boxes[i] to the box of primitive first + i. Several threads call it at once.
using BoxSource = std::function<void(std::size_t first, std::span<Bounds> boxes)>;

// A tree for many rays. Boxes that are empty or not finite are left out. At most kMaxDepth deep.
// Throws Cancelled, or std::bad_alloc: at its peak it takes 32 bytes a box beside the tree itself.
Bvh build_bvh(std::size_t count, const BoxSource& boxes, const BvhOptions& options);
Bvh build_bvh(std::span<const Bounds> boxes, int threads, const std::stop_token& stop);

// Gives the nodes the bounds of moved boxes; which boxes stand in which leaf remains. The tree gets
// slower the more the order of things has changed: sah_cost tells. A box that is empty or not
// finite counts for nothing, and one that was left out when the tree was built remains so. Throws
// Cancelled; the tree then is good for another refit only.
void refit(Bvh& bvh, const BoxSource& boxes, int threads, const std::stop_token& stop);

// What a random ray through the root's box pays on average (MacDonald and Booth, "Heuristics for
// Ray Tracing Using Space Subdivision", 1990). 0 for an empty tree.
double sah_cost(const Bvh& bvh, const LeafCosts& costs);

}  // namespace raypick
