#include "tracer/geometry/pixel.h"

#include <algorithm>
#include <bit>

namespace raypick {

namespace {

constexpr int kSmallestSquare = 4;

void add_square(const ImageSize& size, Pixel corner, int side, std::vector<Pixel>& pixels) {
    if (!size.contains(corner)) return;
    if (side == kSmallestSquare) {
        for (int row = corner.row; row < std::min(corner.row + side, size.rows); ++row) {
            for (int col = corner.col; col < std::min(corner.col + side, size.cols); ++col)
                pixels.push_back({row, col});
        }
        return;
    }
    const int half = side / 2;
    for (const int row : {corner.row, corner.row + half}) {
        for (const int col : {corner.col, corner.col + half})
            add_square(size, {row, col}, half, pixels);
    }
}

}  // namespace

std::vector<Pixel> pixels_in_squares(ImageSize size) {
    std::vector<Pixel> pixels;
    pixels.reserve(size.pixel_count());
    const auto longest = static_cast<unsigned>(std::max({size.rows, size.cols, kSmallestSquare}));
    add_square(size, {0, 0}, static_cast<int>(std::bit_ceil(longest)), pixels);
    return pixels;
}

}  // namespace raypick
