#include "tracer/bvh/sah_split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

// Few bins for few boxes, where finding the best of many would take longer than filling them.
int bins_for(std::size_t refs) {
    return refs < 16 ? 8 : refs < 512 ? 16 : 32;
}

// The cost of all splits of one axis, by their first bin of the right side.
class AxisSweep {
public:
    AxisSweep(const Bins& bins, int axis, int block_shift)
        : bins_(bins), axis_(axis), shift_(block_shift), half_block_((1u << block_shift) - 1u) {}

    void update(Split& best) {
        fill_right_costs();
        Box4 left;
        std::uint32_t count = 0;
        for (int i = 1; i < bins_.size(); ++i) {
            left.extend(bins_.box(axis_, i - 1));
            count += bins_.count(axis_, i - 1);
            // With nothing on one side this is a NaN.
            const float cost = cost_of(left, count) + right_cost_[static_cast<std::size_t>(i)];
            if (cost < best.cost) best = {axis_, i, cost};
        }
    }

private:
    void fill_right_costs() {
        Box4 right;
        std::uint32_t count = 0;
        for (int i = bins_.size() - 1; i > 0; --i) {
            right.extend(bins_.box(axis_, i));
            count += bins_.count(axis_, i);
            right_cost_[static_cast<std::size_t>(i)] = cost_of(right, count);
        }
    }

    [[nodiscard]] float cost_of(const Box4& box, std::uint32_t count) const {
        const auto blocks = static_cast<std::int32_t>((count + half_block_) >> shift_);
        return box.half_area() * static_cast<float>(blocks);
    }

    const Bins& bins_;
    int axis_;
    int shift_;
    std::uint32_t half_block_;
    std::array<float, Bins::kMost> right_cost_;
};

// Around twice the centres of either side. Lanes are switched off by making them NaN, which min4
// and max4 pass over.
class CentresOfSides {
public:
    void add(Float4 twice_centre, Int4 on_right) {
        const Float4 left = from_bits(bits_of(twice_centre) | on_right);
        const Float4 right = from_bits(bits_of(twice_centre) | ~on_right);
        left_.extend_by_known(left);
        right_.extend_by_known(right);
    }
    [[nodiscard]] SplitSides sides(std::size_t left) const {
        return {left, {left_.min, left_.max}, {right_.min, right_.max}};
    }

private:
    struct Known : Box4 {
        void extend_by_known(Float4 p) {
            min = min4(p, min);
            max = max4(p, max);
        }
    };
    Known left_;
    Known right_;
};

// Lomuto's scheme without branches: which side a box falls on can't be foretold.
template <int kAxis>
SplitSides partition_along(std::span<BoxRef> refs, const Binning& binning, int bin) {
    const Float4 threshold = all4(static_cast<float>(bin));
    CentresOfSides centres;
    std::size_t left = 0;
    for (BoxRef& place : refs) {
        const BoxRef ref = place;
        const Float4 at = binning.place(ref);
        const Int4 on_right =
            __builtin_shufflevector(at, at, kAxis, kAxis, kAxis, kAxis) >= threshold;
        place = refs[left];
        refs[left] = ref;
        left += static_cast<std::size_t>(1 + on_right[0]);
        centres.add(ref.twice_centre(), on_right);
    }
    return centres.sides(left);
}

int longest_axis(const Box4& box) {
    const Float4 e = box.max - box.min;
    if (e[0] >= e[1]) return e[0] >= e[2] ? 0 : 2;
    return e[1] >= e[2] ? 1 : 2;
}

}  // namespace

bool can_bin(const RefBounds& bounds) {
    const float area = bounds.boxes.half_area();
    const Float4 extent = bounds.centres.max - bounds.centres.min;
    const float longest = std::max({extent[0], extent[1], extent[2]});
    const float zero = (extent[0] - extent[0]) + (extent[1] - extent[1]) + (extent[2] - extent[2]);
    return area > 1e-30f && area < 1e30f && longest > 0.0f && zero == 0.0f;
}

Binning::Binning(const Box4& twice_centres, std::size_t refs)
    : base_(twice_centres.min), scale_(all4(0.0f)), count_(bins_for(refs)) {
    // A little less than the number of bins, so that rounding leads into none beyond the last.
    const float bins = static_cast<float>(count_) * (1.0f - 1e-5f);
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = twice_centres.max[axis] - twice_centres.min[axis];
        const float scale = bins / extent;
        constexpr float kLargest = 1e30f;  // else the range is too thin to be divided
        if (scale > 0.0f && scale < kLargest) scale_[axis] = scale;
    }
    // The index in this lane is a denormal number, and those are slow to multiply.
    base_[3] = 1.0f;
}

Bins::Bins(const Binning& binning) : size_(binning.count()) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Bin empty{all4(kInfinity), all4(-kInfinity), 0};
    for (int axis = 0; axis < 3; ++axis)
        std::fill_n(bins_.begin() + static_cast<std::ptrdiff_t>(at(axis, 0)), size_, empty);
}

void Bins::add(std::span<const BoxRef> refs, const Binning& binning) {
    for (const BoxRef& ref : refs) {
        const Int4 bin = __builtin_convertvector(binning.place(ref), Int4);
        for (int axis = 0; axis < 3; ++axis)
            bins_[at(axis, bin[axis])].extend(ref.min, ref.max, 1);
    }
}

void Bins::extend(const Bins& other) {
    for (int axis = 0; axis < 3; ++axis) {
        for (int bin = 0; bin < size_; ++bin) {
            const Bin& more = other.bins_[at(axis, bin)];
            bins_[at(axis, bin)].extend(more.min, more.max, more.count);
        }
    }
}

Box4 Bins::box(int axis, int begin, int end) const {
    Box4 sum;
    for (int bin = begin; bin < end; ++bin)
        sum.extend(box(axis, bin));
    return sum;
}

Split best_split(const Bins& bins, const Binning& binning, const LeafCosts& costs) {
    Split best;
    const int shift = std::countr_zero(costs.block_size);
    for (int axis = 0; axis < 3; ++axis) {
        if (!binning.flat(axis)) AxisSweep(bins, axis, shift).update(best);
    }
    return best;
}

SplitSides partition(std::span<BoxRef> refs, const Binning& binning, const Split& split) {
    if (split.axis == 0) return partition_along<0>(refs, binning, split.bin);
    if (split.axis == 1) return partition_along<1>(refs, binning, split.bin);
    return partition_along<2>(refs, binning, split.bin);
}

std::size_t halve(std::span<BoxRef> refs, const Box4& twice_centres) {
    const int axis = longest_axis(twice_centres);
    const std::size_t middle = refs.size() / 2;
    std::nth_element(refs.begin(), refs.begin() + static_cast<std::ptrdiff_t>(middle), refs.end(),
                     [axis](const BoxRef& a, const BoxRef& b) {
                         const float ca = a.twice_centre()[axis];
                         const float cb = b.twice_centre()[axis];
                         return ca != cb ? ca < cb : a.index() < b.index();
                     });
    return middle;
}

}  // namespace raypick
