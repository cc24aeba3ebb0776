// What the builders share.
#pragma once

#include "tracer/bvh/box_refs.h"
#include "tracer/bvh/bvh.h"

namespace raypick {

// From this depth on ranges are halved, so that no tree gets deeper than Bvh::kMaxDepth: 2^32 boxes
// are halved 32 times.
inline constexpr int kMaxSplitDepth = Bvh::kMaxDepth - 34;

// By the surface area heuristic down to max_split_depth. Takes the refs, and frees them as soon as
// they are of no more use. Throws Cancelled.
Bvh build_over_refs(RefArray array, const BvhOptions& options,
                    int max_split_depth = kMaxSplitDepth);

}  // namespace raypick
