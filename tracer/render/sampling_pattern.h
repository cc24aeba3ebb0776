// Where the rays of a pixel go: n x n places in the pixel's filter and on the lens, in cells of
// equal share.
#pragma once

#include "tracer/render/pixel_filter.h"
#include "tracer/shade/settings.h"

#include <glm/vec2.hpp>

#include <cstdint>

namespace raypick {

// One of them.
struct PixelSample {
    glm::dvec2 offset{0.0};  // from the pixel's centre in pixels: x along the columns, y the rows
    bool negative = false;   // the filter is below 0 there
    glm::dvec2 lens{0.0};    // in the unit disk
    std::uint64_t seed = 0;  // of whatever else is random on the ray's way
};

// Depends on the settings' seed, the pixel and the sample's number alone. Samples come in an order
// that is shuffled for each pixel, so that a picture of the first few of all pixels is not shifted.
class SamplingPattern {
public:
    // By `samples`, `filter` and `seed`.
    explicit SamplingPattern(const RenderSettings& settings);

    // Samples of a pixel.
    [[nodiscard]] int count() const { return side_ * side_; }
    // `index` in [0, count()); `pixel` is its number in the image.
    [[nodiscard]] PixelSample sample(std::uint64_t pixel, int index) const;
    [[nodiscard]] const FilterSampler& filter() const { return filter_; }

private:
    int side_;
    std::uint64_t seed_;
    FilterSampler filter_;
};

// `index` after a shuffle of [0, count) that belongs to `key`.
std::uint32_t shuffled(std::uint32_t index, std::uint32_t count, std::uint64_t key);

}  // namespace raypick
