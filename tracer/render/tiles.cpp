#include "tracer/render/tiles.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

double distance_squared(const Tile& tile, ImageSize image) {
    const double r = 0.5 * (tile.row_begin + tile.row_end - image.rows);
    const double c = 0.5 * (tile.col_begin + tile.col_end - image.cols);
    return r * r + c * c;
}

// As the screen shows it: what is brighter than white looks like white.
glm::vec3 seen(const glm::vec3& colour) {
    const glm::vec3 shown = glm::clamp(colour, 0.0f, 1.0f);
    return {srgb_from_linear(shown.x), srgb_from_linear(shown.y), srgb_from_linear(shown.z)};
}

float difference(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z});
}

// A tile and what lies around it, clipped to the image.
Tile grown(const Tile& tile, int by, ImageSize size) {
    return {std::max(tile.row_begin - by, 0), std::min(tile.row_end + by, size.rows),
            std::max(tile.col_begin - by, 0), std::min(tile.col_end + by, size.cols)};
}

}  // namespace

std::vector<Tile> tiles_from_centre(ImageSize size, int side) {
    std::vector<Tile> tiles;
    for (int row = 0; row < size.rows; row += side) {
        for (int col = 0; col < size.cols; col += side) {
            tiles.push_back(
                {row, std::min(row + side, size.rows), col, std::min(col + side, size.cols)});
        }
    }
    std::stable_sort(tiles.begin(), tiles.end(), [&](const Tile& a, const Tile& b) {
        return distance_squared(a, size) < distance_squared(b, size);
    });
    return tiles;
}

TilePart::TilePart(const Tile& where, Channels channels)
    : tile(where), image(make_image(where.size(), channels)), broken(image.size.pixel_count(), 0) {}

void copy_tile(const Image& from, const Tile& tile, Image& to) {
    copy_tile(from.colour, tile, to.colour, to.size);
    copy_tile(from.depth, tile, to.depth, to.size);
    copy_tile(from.normal, tile, to.normal, to.size);
    copy_tile(from.object, tile, to.object, to.size);
    copy_tile(from.primitive, tile, to.primitive, to.size);
}

std::vector<std::uint8_t> contrasting_pixels(const Image& image, const Tile& tile, int reach,
                                             float contrast) {
    const Tile around = grown(tile, reach, image.size);
    const ImageSize around_size = around.size();
    std::vector<glm::vec3> colours(around_size.pixel_count());
    for (int row = 0; row < around_size.rows; ++row) {
        for (int col = 0; col < around_size.cols; ++col) {
            colours[around_size.index({row, col})] =
                seen(image.colour[image.size.index(around.in_image({row, col}))]);
        }
    }
    const auto at = [&](int row, int col) -> const glm::vec3& {
        return colours[around_size.index({row - around.row_begin, col - around.col_begin})];
    };
    const auto contrasts = [&](const Pixel& pixel) {
        const Tile window =
            grown({pixel.row, pixel.row + 1, pixel.col, pixel.col + 1}, reach, image.size);
        for (int row = window.row_begin; row < window.row_end; ++row) {
            for (int col = window.col_begin; col < window.col_end; ++col) {
                if (difference(at(row, col), at(pixel.row, pixel.col)) > contrast) return true;
            }
        }
        return false;
    };
    const ImageSize size = tile.size();
    std::vector<std::uint8_t> result(size.pixel_count(), 0);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            result[size.index({row, col})] = contrasts(tile.in_image({row, col})) ? 1 : 0;
        }
    }
    return result;
}

}  // namespace raypick
