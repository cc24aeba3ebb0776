// Which of a few triangles' corners are at the same place.
#pragma once

#include "tracer/accel/triangle_patches.h"

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

// What a patch has taken.
struct SharedCorners {
    std::uint32_t triangles = 0;
    std::uint32_t corners = 0;  // at different places
};

// What is overwritten behind a patch, at most, in floats.
inline constexpr std::size_t kWrittenBeyondPatch = 16;

// Makes a patch of the first of these triangles that have no more than sixteen corners together:
// sets its numbers of corners, and the coordinates behind the primitives, which are not set here.
// Corners are numbered in the order in which they come; those at the same place, bit for bit, have
// the same number.
SharedCorners share_corners(const CornerPlaces& places, std::size_t triangles,
                            TrianglePatch& patch);

}  // namespace raypick
