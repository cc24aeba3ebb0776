// Boxes in the order of a space-filling curve.
//
// Source: Morton, "A computer oriented geodetic data base", 1966; for trees Lauterbach, Garland,
// Sengupta, Luebke, Manocha, "Fast BVH Construction on GPUs", 2009.
#pragma once

#include "tracer/bvh/box_refs.h"

#include <cstdint>

namespace raypick {

struct MortonKey {
    std::uint32_t code = 0;   // 10 bits of x, y and z in turn, x's the highest
    std::uint32_t place = 0;  // of the box among the refs
};

// Of all refs, by code, then by place. Throws Cancelled.
LargeArray<MortonKey> morton_order(const RefArray& array, const BvhOptions& options);

}  // namespace raypick
