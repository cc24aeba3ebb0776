// The boxes that a tree is built over, as builders move them about.
#pragma once

#include "tracer/bvh/bvh.h"
#include "tracer/bvh/float4.h"
#include "tracer/parallel/large_array.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace raypick {

// A box and whose it is: the index stands in the bits of min's fourth lane.
struct BoxRef {
    Float4 min;
    Float4 max;

    [[nodiscard]] std::uint32_t index() const {
        return static_cast<std::uint32_t>(bits_of(min)[3]);
    }
    // Twice the centre, which saves a multiplication; the fourth lane means nothing.
    [[nodiscard]] Float4 twice_centre() const { return min + max; }
    [[nodiscard]] Box4 box() const { return {min, max}; }
};

inline BoxRef with_index(const BoxRef& ref, std::uint32_t index) {
    Int4 bits = bits_of(ref.min);
    bits[3] = static_cast<std::int32_t>(index);
    return {from_bits(bits), ref.max};
}

inline Box4 box4(const Bounds& box) {
    return {Float4{box.min.x, box.min.y, box.min.z, 0.0f},
            Float4{box.max.x, box.max.y, box.max.z, 0.0f}};
}

inline BoxRef make_ref(const Box4& box, std::uint32_t index) {
    return with_index({box.min, box.max}, index);
}

// Neither empty nor infinite nor NaN, of which the last two times 0 are a NaN.
inline bool is_usable(const Box4& box) {
    const Int4 usable = (box.min <= box.max) & (0.0f * box.min + 0.0f * box.max == 0.0f);
    return (usable[0] & usable[1] & usable[2]) != 0;
}

// Of a range of refs: around the boxes, and around twice their centres.
struct RefBounds {
    Box4 boxes;
    Box4 centres;

    void extend(const BoxRef& ref) {
        boxes.extend(ref.box());
        centres.extend(ref.twice_centre());
    }
    void extend(const RefBounds& other) {
        boxes.extend(other.boxes);
        centres.extend(other.centres);
    }
};

RefBounds measure(std::span<const BoxRef> refs);

// The refs that there are, in an array with room for more.
struct RefArray {
    LargeArray<BoxRef> storage;
    std::size_t count = 0;
    RefBounds bounds;

    [[nodiscard]] std::span<BoxRef> refs() { return {storage.data(), count}; }
    [[nodiscard]] std::span<const BoxRef> refs() const { return {storage.data(), count}; }
};

// Room for `count` refs, uninitialised and empty. Throws std::bad_alloc.
RefArray allocate_refs(std::size_t count);

// Refs of all usable boxes, in order. Throws Cancelled.
RefArray make_refs(std::size_t count, const BoxSource& boxes, const BvhOptions& options);

}  // namespace raypick
