// A frame in pieces that threads work on.
#pragma once

#include "tracer/geometry/pixel.h"
#include "tracer/render/image.h"
#include "tracer/shade/eye_ray.h"
#include "tracer/shade/ray_counts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raypick {

inline constexpr int kTileSize = 32;

// Pixels [row_begin, row_end) x [col_begin, col_end).
struct Tile {
    int row_begin = 0;
    int row_end = 0;
    int col_begin = 0;
    int col_end = 0;

    [[nodiscard]] ImageSize size() const { return {row_end - row_begin, col_end - col_begin}; }
    // From a pixel of the tile's own to one of the image.
    [[nodiscard]] Pixel in_image(Pixel pixel) const {
        return {row_begin + pixel.row, col_begin + pixel.col};
    }
};

// All tiles of an image, those nearest to its centre first.
std::vector<Tile> tiles_from_centre(ImageSize size, int side = kTileSize);

// What one thread made of a tile.
struct TilePart {
    explicit TilePart(const Tile& where, Channels channels = Channels::all);

    // Pixels by their number in the tile. A colour or a normal that is not finite is kept as 0, and
    // the pixel counts as broken.
    void set(std::size_t pixel, const TracedRays& traced, std::size_t i) {
        set_colour(pixel, traced.colours[i]);
        if (has_all()) set_hit(pixel, traced.hits[i], traced.normals[i]);
    }
    void set_hit(std::size_t pixel, const Hit& hit, const glm::vec3& normal) {
        if (!hit.valid()) return;
        image.depth[pixel] = hit.t;
        image.object[pixel] = hit.object;
        image.primitive[pixel] = hit.primitive;
        image.normal[pixel] = checked(pixel, normal);
    }
    // Else the colour alone.
    [[nodiscard]] bool has_all() const { return !image.depth.empty(); }
    void set_colour(std::size_t pixel, const glm::vec3& colour) {
        image.colour[pixel] = checked(pixel, colour);
    }

    Tile tile;
    Image image;                       // of the tile's size
    std::vector<std::uint8_t> broken;  // per pixel: 1 or 0
    bool any_broken = false;
    RayCounts rays;

private:
    glm::vec3 checked(std::size_t pixel, const glm::vec3& v) {
        // 0 times infinity or NaN is NaN.
        const glm::vec3 zero = 0.0f * v;
        if (zero.x + zero.y + zero.z == 0.0f) return v;
        any_broken = true;
        broken[pixel] = 1;
        return glm::vec3(0.0f);
    }
};

// Writes a tile's channel into that of the image, or nothing if it is empty.
template <typename T>
void copy_tile(const std::vector<T>& from, const Tile& tile, std::vector<T>& to, ImageSize size) {
    const ImageSize small = tile.size();
    for (int row = 0; row < small.rows && !from.empty(); ++row) {
        const auto first = from.begin() + static_cast<std::ptrdiff_t>(small.index({row, 0}));
        const std::size_t target = size.index({tile.row_begin + row, tile.col_begin});
        std::copy(first, first + small.cols, to.begin() + static_cast<std::ptrdiff_t>(target));
    }
}
void copy_tile(const Image& from, const Tile& tile, Image& to);

// For each pixel of a tile, in the tile's order: 1 if its colour differs by more than `contrast` in
// sRGB from that of a pixel up to `reach` rows and columns away, else 0.
std::vector<std::uint8_t> contrasting_pixels(const Image& image, const Tile& tile, int reach,
                                             float contrast);

}  // namespace raypick
