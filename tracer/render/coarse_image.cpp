#include "tracer/render/coarse_image.h"

#include <algorithm>

namespace raypick {

namespace {

template <typename T>
void fill_tile(const std::vector<T>& from, ImageSize grid, int step, const Tile& tile,
               std::vector<T>& to, ImageSize size) {
    for (int row = tile.row_begin; row < tile.row_end && !from.empty(); ++row) {
        for (int col = tile.col_begin; col < tile.col_end; ++col)
            to[size.index({row, col})] = from[grid.index(block_of({row, col}, step))];
    }
}

}  // namespace

ImageSize block_grid(ImageSize size, int step) {
    return {(size.rows + step - 1) / step, (size.cols + step - 1) / step};
}

Pixel block_of(Pixel pixel, int step) {
    return {pixel.row / step, pixel.col / step};
}

Pixel block_sample(Pixel block, int step, ImageSize size) {
    return {std::min(block.row * step + step / 2, size.rows - 1),
            std::min(block.col * step + step / 2, size.cols - 1)};
}

CoarseImage::CoarseImage(ImageSize frame_size, int block_step, Channels channels)
    : size(frame_size),
      step(block_step),
      image(make_image(block_grid(frame_size, block_step), channels)),
      broken(image.size.pixel_count(), 0) {}

void fill_tile(const Image& blocks, int step, const Tile& tile, Image& image) {
    fill_tile(blocks.colour, blocks.size, step, tile, image.colour, image.size);
    fill_tile(blocks.depth, blocks.size, step, tile, image.depth, image.size);
    fill_tile(blocks.normal, blocks.size, step, tile, image.normal, image.size);
    fill_tile(blocks.object, blocks.size, step, tile, image.object, image.size);
    fill_tile(blocks.primitive, blocks.size, step, tile, image.primitive, image.size);
}

bool take_sample(const CoarseImage& coarse, Pixel pixel, TilePart& part, std::size_t number) {
    const Pixel block = block_of(pixel, coarse.step);
    if (block_sample(block, coarse.step, coarse.size) != pixel) return false;
    const std::size_t from = coarse.image.size.index(block);
    part.image.colour[number] = coarse.image.colour[from];
    part.broken[number] = coarse.broken[from];
    part.any_broken = part.any_broken || coarse.broken[from] != 0;
    if (!part.has_all()) return true;
    part.image.depth[number] = coarse.image.depth[from];
    part.image.normal[number] = coarse.image.normal[from];
    part.image.object[number] = coarse.image.object[from];
    part.image.primitive[number] = coarse.image.primitive[from];
    return true;
}

}  // namespace raypick
