#include "tracer/bvh/parallel_split.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <vector>

namespace raypick {

namespace {

// Work goes by chunks of this many refs whatever the number of threads, since the order in which
// refs end up depends on it.
constexpr std::size_t kRefsInChunk = 1u << 13;

std::size_t chunks_of(std::size_t refs) {
    return (refs + kRefsInChunk - 1) / kRefsInChunk;
}

std::span<BoxRef> chunk_of(std::span<BoxRef> refs, std::size_t chunk) {
    const std::size_t begin = chunk * kRefsInChunk;
    return refs.subspan(begin, std::min(kRefsInChunk, refs.size() - begin));
}

template <typename Body>
void for_chunks(std::size_t count, const BvhOptions& options, const Body& body) {
    parallel_for(count, options.threads, options.stop, body);
    if (options.stop.stop_requested()) throw Cancelled();
}

Bins fill_bins(std::span<BoxRef> refs, const Binning& binning, const BvhOptions& options) {
    std::vector<Bins> bins(chunks_of(refs.size()), Bins(binning));
    for_chunks(bins.size(), options,
               [&](std::size_t i) { bins[i].add(chunk_of(refs, i), binning); });
    for (std::size_t i = 1; i < bins.size(); ++i)
        bins[0].extend(bins[i]);
    return bins[0];
}

// As many refs at `a` as at `b`, to be swapped.
struct Swap {
    std::size_t a = 0;
    std::size_t b = 0;
    std::size_t count = 0;
};

// A run of refs on the wrong side.
struct Run {
    std::size_t begin = 0;
    std::size_t end = 0;
};

std::vector<Swap> pair_up(std::span<Run> lefts, std::span<Run> rights) {
    std::vector<Swap> swaps;
    auto right = rights.begin();
    for (Run& left : lefts) {
        while (left.begin < left.end) {
            const std::size_t count = std::min(left.end - left.begin, right->end - right->begin);
            swaps.push_back({left.begin, right->begin, count});
            left.begin += count;
            right->begin += count;
            if (right->begin == right->end) ++right;
        }
    }
    return swaps;
}

// Which runs to swap so that chunks, each partitioned, become one partitioned range.
std::vector<Swap> join_chunks(std::span<const SplitSides> chunks, std::size_t refs,
                              std::size_t middle) {
    std::vector<Run> lefts;   // of the left side's refs behind the middle
    std::vector<Run> rights;  // of the right side's refs before it
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        const std::size_t begin = i * kRefsInChunk;
        const std::size_t border = begin + chunks[i].left;
        const std::size_t end = std::min(begin + kRefsInChunk, refs);
        if (border > middle) lefts.push_back({std::max(begin, middle), border});
        if (border < middle) rights.push_back({border, std::min(end, middle)});
    }
    return pair_up(lefts, rights);
}

SplitSides partition_parallel(std::span<BoxRef> refs, const Binning& binning, const Split& split,
                              const BvhOptions& options) {
    std::vector<SplitSides> chunks(chunks_of(refs.size()));
    for_chunks(chunks.size(), options,
               [&](std::size_t i) { chunks[i] = partition(chunk_of(refs, i), binning, split); });
    SplitSides all;
    for (const SplitSides& chunk : chunks) {
        all.left += chunk.left;
        all.left_centres.extend(chunk.left_centres);
        all.right_centres.extend(chunk.right_centres);
    }
    const std::vector<Swap> swaps = join_chunks(chunks, refs.size(), all.left);
    for_chunks(swaps.size(), options, [&](std::size_t i) {
        BoxRef* const a = refs.data() + swaps[i].a;
        std::swap_ranges(a, a + swaps[i].count, refs.data() + swaps[i].b);
    });
    return all;
}

}  // namespace

Division divided(const Bins& bins, const Split& split, const SplitSides& sides) {
    return {sides.left,
            {bins.box(split.axis, 0, split.bin), sides.left_centres},
            {bins.box(split.axis, split.bin, bins.size()), sides.right_centres}};
}

Division halve_range(std::span<BoxRef> refs, const RefBounds& bounds) {
    const std::size_t middle = halve(refs, bounds.centres);
    return {middle, measure(refs.first(middle)), measure(refs.subspan(middle))};
}

Division divide_parallel(std::span<BoxRef> refs, const RefBounds& bounds,
                         const BvhOptions& options) {
    if (!can_bin(bounds)) return halve_range(refs, bounds);
    const Binning binning(bounds.centres, refs.size());
    const Bins bins = fill_bins(refs, binning, options);
    const Split split = best_split(bins, binning, options.costs);
    if (split.axis < 0) return halve_range(refs, bounds);
    return divided(bins, split, partition_parallel(refs, binning, split, options));
}

}  // namespace raypick
