// How fine a coarse image may be so that it is there in time, by how long former ones took.
#pragma once

#include "tracer/geometry/pixel.h"

#include <array>
#include <cstddef>

namespace raypick {

// Knows no clock: the same measurements give the same answers.
class CoarsePace {
public:
    static constexpr int kCoarsest = 16;  // no block is larger, however long it takes
    static constexpr int kUnknown = 8;    // as long as nothing was measured

    // `budget`: seconds that a coarse image may take.
    explicit CoarsePace(double budget) : budget_(budget) {}

    // The side of the next image's blocks: the smallest that fits the budget, as far as one can
    // say. It gets smaller only if that leaves a quarter of the budget, so that it does not change
    // with every little thing.
    [[nodiscard]] int step_for(ImageSize size) const;
    // An image of this size took so long with blocks of this side.
    void learn(ImageSize size, int step, double seconds);

private:
    [[nodiscard]] int finest_within(double seconds, ImageSize size) const;
    // Seconds a block: the median of the last ones, so that one hold-up counts for nothing.
    [[nodiscard]] double cost() const;

    double budget_;
    std::array<double, 5> costs_{};
    std::size_t measured_ = 0;
    int last_step_ = kUnknown;
};

}  // namespace raypick
