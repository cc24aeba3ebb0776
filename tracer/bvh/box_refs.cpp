#include "tracer/bvh/box_refs.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace raypick {

namespace {

constexpr std::size_t kBoxesInChunk = 1u << 14;

struct Chunk {
    std::size_t count = 0;
    RefBounds bounds;
};

// The boxes [begin, end) into the place that they have if none is left out.
Chunk fill_chunk(const BoxSource& boxes, std::size_t begin, std::size_t end, BoxRef* refs) {
    std::array<Bounds, 128> some;
    Chunk chunk;
    for (std::size_t i = begin; i < end; i += some.size()) {
        const std::span<Bounds> wanted(some.data(), std::min(some.size(), end - i));
        boxes(i, wanted);
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            const Box4 box = box4(wanted[k]);
            if (!is_usable(box)) continue;
            const BoxRef ref = make_ref(box, static_cast<std::uint32_t>(i + k));
            refs[begin + chunk.count++] = ref;
            chunk.bounds.extend(ref);
        }
    }
    return chunk;
}

}  // namespace

RefBounds measure(std::span<const BoxRef> refs) {
    RefBounds bounds;
    for (const BoxRef& ref : refs)
        bounds.extend(ref);
    return bounds;
}

RefArray allocate_refs(std::size_t count) {
    RefArray array;
    array.storage.resize(count);
    return array;
}

RefArray make_refs(std::size_t count, const BoxSource& boxes, const BvhOptions& options) {
    RefArray array = allocate_refs(count);
    std::vector<Chunk> chunks((count + kBoxesInChunk - 1) / kBoxesInChunk);
    parallel_for(chunks.size(), options.threads, options.stop, [&](std::size_t i) {
        chunks[i] = fill_chunk(boxes, i * kBoxesInChunk, std::min(count, (i + 1) * kBoxesInChunk),
                               array.storage.data());
    });
    if (options.stop.stop_requested()) throw Cancelled();
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        BoxRef* begin = array.storage.data() + i * kBoxesInChunk;
        if (array.count != i * kBoxesInChunk)
            std::copy(begin, begin + chunks[i].count, array.storage.data() + array.count);
        array.count += chunks[i].count;
        array.bounds.extend(chunks[i].bounds);
    }
    return array;
}

}  // namespace raypick
