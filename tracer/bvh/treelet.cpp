#include "tracer/bvh/treelet.h"

#include <array>
#include <cassert>

namespace raypick {

namespace {

// From this depth on ranges are halved, so that no treelet gets deeper than kMostTreeletDepth.
constexpr int kMaxCutDepth = 6;
static_assert(kMostTreeletLeaves <= 1u << (kMostTreeletDepth - kMaxCutDepth));

struct LeafRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t node = 0;
    int depth = 0;
};

// Where the range is cut, and the box around all of it.
struct Cut {
    std::uint32_t middle = 0;
    Box4 box;
};

Cut best_cut(std::span<const TreeletLeaf> leaves) {
    std::array<float, kMostTreeletLeaves> right_cost;
    const std::size_t count = leaves.size();
    Box4 right;
    if (count <= 4) {  // one wide node has place for all: where they are cut matters little
        for (const TreeletLeaf& leaf : leaves)
            right.extend(leaf.box);
        return {static_cast<std::uint32_t>(count / 2), right};
    }
    for (std::size_t i = count - 1; i > 0; --i) {
        right.extend(leaves[i].box);
        right_cost[i] = right.half_area() * static_cast<float>(count - i);
    }
    right.extend(leaves[0].box);
    Cut cut{static_cast<std::uint32_t>(count / 2), right};
    const float area = right.half_area();
    if (!(area > 1e-30f && area < 1e30f)) return cut;  // nothing to be told by areas
    float best = std::numeric_limits<float>::infinity();
    Box4 left;
    for (std::size_t i = 1; i < count; ++i) {
        left.extend(leaves[i - 1].box);
        const float cost = left.half_area() * static_cast<float>(i) + right_cost[i];
        if (cost < best) {
            best = cost;
            cut.middle = static_cast<std::uint32_t>(i);
        }
    }
    return cut;
}

}  // namespace

void append_treelet(std::vector<BvhNode>& nodes, std::span<const TreeletLeaf> leaves) {
    assert(!leaves.empty() && leaves.size() <= kMostTreeletLeaves);
    const std::size_t root = nodes.size();
    std::array<LeafRange, kMostTreeletLeaves> todo;
    std::size_t waiting = 0;
    todo[waiting++] = {0, static_cast<std::uint32_t>(leaves.size()), 0, 0};
    nodes.emplace_back();
    while (waiting > 0) {
        const LeafRange range = todo[--waiting];
        BvhNode& node = nodes[root + range.node];
        if (range.end - range.begin == 1) {
            const TreeletLeaf& leaf = leaves[range.begin];
            node = {leaf.box.bounds(), leaf.first, leaf.count};
            continue;
        }
        const std::uint32_t count = range.end - range.begin;
        Cut cut = best_cut(leaves.subspan(range.begin, count));
        if (range.depth >= kMaxCutDepth) cut.middle = count / 2;
        const auto child = static_cast<std::uint32_t>(nodes.size() - root);
        node = {cut.box.bounds(), child, 0};
        todo[waiting++] = {range.begin + cut.middle, range.end, child + 1, range.depth + 1};
        todo[waiting++] = {range.begin, range.begin + cut.middle, child, range.depth + 1};
        nodes.resize(nodes.size() + 2);
    }
}

}  // namespace raypick
