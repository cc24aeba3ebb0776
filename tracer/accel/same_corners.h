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

// The first of these triangles that have no more than sixteen corners together.
struct SharedCorners {
    static constexpr std::size_t kWrittenBeyond = 16;  // the last corner, at most

    std::uint32_t triangles = 0;
    std::uint32_t count = 0;                // of corners at different places
    std::uint32_t firsts = 0;               // bit i: corner i is the first at its place
    std::array<std::uint32_t, 3> number{};  // of corner k of triangle i: bits 4 i to 4 i + 3
};

// Corners are numbered in the order in which they come; those at the same place, bit for bit, have
// the same number. Writes their coordinates to `out`, axis by axis, behind a place for each of the
// triangles. There must be room for kWrittenBeyond more.
SharedCorners share_corners(const CornerPlaces& places, std::size_t triangles, std::uint32_t* out);

}  // namespace raypick
