// Splitting a large range of boxes on several threads.
#pragma once

#include "tracer/bvh/box_refs.h"
#include "tracer/bvh/bvh.h"
#include "tracer/bvh/sah_split.h"

#include <cstddef>
#include <span>

namespace raypick {

// A range cut in two: [0, middle) and the rest.
struct Division {
    std::size_t middle = 0;  // 0: not divided
    RefBounds left;
    RefBounds right;
};

// What `sides` gave, with the boxes that the bins know.
Division divided(const Bins& bins, const Split& split, const SplitSides& sides);

Division halve_range(std::span<BoxRef> refs, const RefBounds& bounds);

// By the best split, else into halves; never undivided. Throws Cancelled.
Division divide_parallel(std::span<BoxRef> refs, const RefBounds& bounds,
                         const BvhOptions& options);

}  // namespace raypick
