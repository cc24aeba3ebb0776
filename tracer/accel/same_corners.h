// Which of a few triangles' corners are at the same place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// Corners of up to eight triangles, axis by axis: the bits of their coordinates. Vectors may be
// read beyond the last one.
struct CornerPlaces {
    static constexpr std::size_t kMost = 24;

    alignas(64) std::array<std::array<std::uint32_t, 32>, 3> along;  // not initialised
};

using FirstCorners = std::array<std::uint32_t, CornerPlaces::kMost>;

// Of each of the first `count` corners the first one at its place, bit for bit.
void find_first_corners(const CornerPlaces& places, std::size_t count, FirstCorners& first);

}  // namespace raypick
