#include "tracer/geometry/pixel.h"

#include <algorithm>
#include <bit>

namespace raypick {

namespace {

constexpr int kSmallestSquare = 4;

// Writes the square's pixels to `to` and returns the end of what it wrote.
Pixel* put_square(ImageSize size, Pixel corner, int side, Pixel* to) {
    if (!size.contains(corner)) return to;
    if (side == kSmallestSquare) {
        const Pixel end{std::min(corner.row + side, size.rows),
                        std::min(corner.col + side, size.cols)};
        for (int row = corner.row; row < end.row; ++row) {
            for (int col = corner.col; col < end.col; ++col)
                *to++ = {row, col};
        }
        return to;
    }
    const int half = side / 2;
    for (const int row : {corner.row, corner.row + half}) {
        for (const int col : {corner.col, corner.col + half})
            to = put_square(size, {row, col}, half, to);
    }
    return to;
}

}  // namespace

std::vector<Pixel> pixels_in_squares(ImageSize size) {
    std::vector<Pixel> pixels(size.pixel_count());
    const auto longest = static_cast<unsigned>(std::max({size.rows, size.cols, kSmallestSquare}));
    put_square(size, {0, 0}, static_cast<int>(std::bit_ceil(longest)), pixels.data());
    return pixels;
}

}  // namespace raypick
