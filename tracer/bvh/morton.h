// Boxes in the order of a space-filling curve.
//
// Source: Morton, "A computer oriented geodetic data base", 1966; for trees Lauterbach, Garland,
// Sengupta, Luebke, Manocha, "Fast BVH Construction on GPUs", 2009.
#pragma once

#include "tracer/bvh/box_refs.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace raypick {

struct MortonKey {
    std::uint32_t code = 0;  // 10 bits of x, y and z in turn, x's the highest
    std::uint32_t index = 0;
};

// As BoxSource.
using Box4Source = std::function<void(std::size_t first, std::span<Box4> boxes)>;

// Of all usable boxes, by code, then by index. `around` is a box around them, perhaps a larger one
// than need be: it saves time if it is at hand, and is empty if not. Throws Cancelled.
LargeArray<MortonKey> morton_order(std::size_t count, const Box4Source& boxes, const Box4& around,
                                   const BvhOptions& options);

}  // namespace raypick
