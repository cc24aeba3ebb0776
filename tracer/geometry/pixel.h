// Pixels and image points: row 0 is the TOP row, column 0 the left one, everywhere.
#pragma once

#include <cstddef>
#include <vector>

namespace raypick {

// A pixel. The only pixel type; never two bare ints.
struct Pixel {
    int row = 0;
    int col = 0;

    friend bool operator==(const Pixel&, const Pixel&) = default;
};

// Image points are the pixel axes as real numbers: pixel (row, col) covers
// [row, row + 1) x [col, col + 1).
struct ImagePoint {
    double r = 0;
    double c = 0;
};

struct ImageSize {
    int rows = 0;
    int cols = 0;

    [[nodiscard]] std::size_t pixel_count() const {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    }
    // Width over height (the notes' alpha).
    [[nodiscard]] double aspect() const { return static_cast<double>(cols) / rows; }
    [[nodiscard]] bool contains(Pixel p) const {
        return p.row >= 0 && p.row < rows && p.col >= 0 && p.col < cols;
    }
    // Position of a pixel in a row-major array, top row first.
    [[nodiscard]] std::size_t index(Pixel p) const {
        return static_cast<std::size_t>(p.row) * static_cast<std::size_t>(cols) +
               static_cast<std::size_t>(p.col);
    }

    friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

// Where OpenGL samples a pixel, and where our rays go by default.
inline ImagePoint pixel_centre(Pixel p) {
    return {p.row + 0.5, p.col + 0.5};
}

// All pixels in Z-order, but row by row in squares of 4 x 4; the right and the lower edge may cut
// squares off. Rays through 16, 64 or more of them in a row go much the same way. Of at most 2^30
// rows and columns.
//
// Source: Morton, "A computer oriented geodetic data base", 1966.
std::vector<Pixel> pixels_in_squares(ImageSize size);

}  // namespace raypick
