// Where to split a range of boxes by the surface area heuristic, and the splitting itself.
//
// Source: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007.
#pragma once

#include "tracer/bvh/box_refs.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace raypick {

// Whether bins can tell apart at all which split is best: not for boxes all on one line, nor where
// areas or centres leave the range of float.
bool can_bin(const RefBounds& bounds);

// Cuts the space of the centres into equal bins along each axis.
class Binning {
public:
    Binning(const Box4& twice_centres, std::size_t refs);

    [[nodiscard]] int count() const { return count_; }
    // An axis along which no two centres can be told apart has one bin.
    [[nodiscard]] bool flat(int axis) const { return scale_[axis] == 0.0f; }
    // At or above 0 and below count(); its whole part is the bin.
    [[nodiscard]] Float4 place(const BoxRef& ref) const {
        return (ref.twice_centre() - base_) * scale_;
    }

private:
    Float4 base_;
    Float4 scale_;
    int count_;
};

// What fell into each bin.
class Bins {
public:
    static constexpr std::size_t kMost = 32;

    explicit Bins(const Binning& binning);
    void add(std::span<const BoxRef> refs, const Binning& binning);
    void extend(const Bins& other);

    [[nodiscard]] Box4 box(int axis, int bin) const {
        const Bin& it = bins_[at(axis, bin)];
        return {it.min, it.max};
    }
    [[nodiscard]] std::uint32_t count(int axis, int bin) const {
        return bins_[at(axis, bin)].count;
    }
    [[nodiscard]] int size() const { return size_; }
    // Around the bins [begin, end).
    [[nodiscard]] Box4 box(int axis, int begin, int end) const;

private:
    // Of a size that makes its place simple to work out. Not a Box4, which would be initialised
    // even where no bin is.
    struct alignas(64) Bin {
        Float4 min;
        Float4 max;
        std::uint32_t count;

        void extend(const Float4& low, const Float4& high, std::uint32_t refs) {
            min = min4(min, low);
            max = max4(max, high);
            count += refs;
        }
    };

    [[nodiscard]] static std::size_t at(int axis, int bin) {
        return static_cast<std::size_t>(axis) * kMost + static_cast<std::uint32_t>(bin);
    }

    int size_;
    std::array<Bin, 3 * kMost> bins_;  // valid up to size_, an axis
};

struct Split {
    int axis = -1;  // -1: none found
    int bin = 0;    // first bin of the right side
    // Half area times blocks, both sides together.
    float cost = std::numeric_limits<float>::infinity();
};

Split best_split(const Bins& bins, const Binning& binning, const LeafCosts& costs);

// Blocks that a leaf of `count` boxes is tested in.
inline float blocks_of(std::uint32_t count, const LeafCosts& costs) {
    const std::uint32_t blocks = (count + costs.block_size - 1) / costs.block_size;
    return static_cast<float>(blocks);
}

// A range after a split: refs of the left side first.
struct SplitSides {
    std::size_t left = 0;  // refs of the left side
    Box4 left_centres;
    Box4 right_centres;
};

// Reorders the refs. The order within a side depends on the refs alone.
SplitSides partition(std::span<BoxRef> refs, const Binning& binning, const Split& split);

// Equal halves by centre along the longest axis: for boxes that no bin tells apart.
std::size_t halve(std::span<BoxRef> refs, const Box4& twice_centres);

}  // namespace raypick
