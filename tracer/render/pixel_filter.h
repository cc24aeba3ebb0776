// Reconstruction filters: how much what lies around a pixel's centre counts for the pixel.
#pragma once

#include "tracer/shade/settings.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace raypick {

// Filters are products of one function a(x) along the columns and along the rows; distances are in
// pixels. a is 0 from the radius on.
//   box       radius 0.5  the pixel itself
//   tent      radius 1    1 - |x|
//   gaussian  radius 1.5  standard deviation 0.5, cut off
//   mitchell  radius 2    B = C = 1/3; negative beyond 8/7 (Mitchell, Netravali, "Reconstruction
//                         Filters in Computer Graphics", SIGGRAPH 1988)
double filter_radius(PixelFilter filter);
// a(x); its integral is 1.
double filter_value(PixelFilter filter, double x);

// A distance from the centre along one axis.
struct FilterOffset {
    double offset = 0.0;
    bool negative = false;  // the filter is below 0 there
};

// Draws places so that each stands for the same share of |filter|: no weights, and a pixel needs
// nothing of its neighbours. Source: Ernst, Stamminger, Greiner, "Filter Importance Sampling",
// Interactive Ray Tracing 2006.
class FilterSampler {
public:
    explicit FilterSampler(PixelFilter filter);

    // Monotonic in u, which lies in [0, 1).
    [[nodiscard]] FilterOffset sample(double u) const;
    // The share that the two-dimensional filter takes off where it is negative; what it adds
    // elsewhere is 1 more.
    [[nodiscard]] double negative_share() const { return negative_share_; }

private:
    PixelFilter filter_;
    double radius_;
    double negative_share_ = 0.0;
    std::vector<double> cumulated_;  // integral of |a| up to the end of each cell, ending with 1
};

// The colour of a pixel from its samples so far. Places where the filter is negative are averaged
// apart from the others, so that few samples can't make the weights' sum vanish and equal samples
// give exactly their colour.
class PixelMean {
public:
    void add(const glm::vec3& colour, bool negative);
    // Linear RGB; never negative, though a filter with negative lobes would have it below black.
    [[nodiscard]] glm::vec3 colour(const FilterSampler& filter) const;

private:
    glm::vec3 positive_{0.0f};
    glm::vec3 negative_{0.0f};
    std::uint16_t positives_ = 0;
    std::uint16_t negatives_ = 0;
};

}  // namespace raypick
