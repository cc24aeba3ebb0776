// Small trees over leaves that are in a good order already.
#pragma once

#include "tracer/bvh/bvh.h"
#include "tracer/bvh/float4.h"

#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

struct TreeletLeaf {
    Box4 box;
    std::uint32_t first = 0;  // of the tree's indices
    std::uint32_t count = 0;
};

// Most leaves that a treelet has.
inline constexpr std::size_t kMostTreeletLeaves = 64;
// Levels below a treelet's root.
inline constexpr int kMostTreeletDepth = 12;

// Keeps the order of the leaves, and cuts it where the surface area heuristic says: of the splits
// that a sweep over the range finds. The root comes first; places of inner nodes are counted from
// it.
void append_treelet(std::vector<BvhNode>& nodes, std::span<const TreeletLeaf> leaves);

}  // namespace raypick
