// A first tree: to be used until the one for many rays is there. Boxes that are near each other
// along a space-filling curve are put into one leaf without a look at other ways.
#pragma once

#include "tracer/bvh/bvh.h"
#include "tracer/bvh/morton.h"
#include "tracer/bvh/treelet.h"
#include "tracer/bvh/wide_bvh.h"

#include <cstddef>
#include <functional>
#include <span>

namespace raypick {

// Leaves are stored by chunks of so many keys.
inline constexpr std::size_t kKeysInChunk = 1u << 12;

// Who holds what is in the leaves.
struct LeafStore {
    // Stores a chunk's leaves. Each comes with its first key and the number of its keys, and goes
    // with its box and its place, counted from the chunk's first place. Returns how many places
    // there are. Several threads call it at once, for different chunks.
    std::function<std::size_t(std::size_t chunk, std::span<const MortonKey> keys,
                              std::span<TreeletLeaf> leaves)>
        store;
    // The places of this chunk follow those of the one before it: called in order, by one thread
    // at a time, but while others store.
    std::function<void(std::size_t chunk)> append;
};

// A tree without indices: its leaves are the store's places. The same for any number of threads.
// Throws Cancelled, and std::length_error for 2^31 places or more.
WideBvh build_over_keys(LargeArray<MortonKey> keys, const LeafStore& store,
                        const BvhOptions& options);

// With indices of its own. Boxes that are empty or not finite are left out; at most Bvh::kMaxDepth
// deep. Throws Cancelled, std::bad_alloc, and std::length_error for 2^31 boxes or more.
WideBvh build_bvh_fast(std::size_t count, const BoxSource& boxes, const BvhOptions& options);

}  // namespace raypick
