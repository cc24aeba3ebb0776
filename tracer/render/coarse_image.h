// The first image of a frame that is watched: one pixel for a block of the frame's.
#pragma once

#include "tracer/render/image.h"
#include "tracer/render/tiles.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace raypick {

// How many blocks of `step` x `step` pixels an image has; those at its edges may be cut off.
ImageSize block_grid(ImageSize size, int step);
// The block that holds a pixel.
Pixel block_of(Pixel pixel, int step);
// The pixel that stands for a block: its centre.
Pixel block_sample(Pixel block, int step, ImageSize size);

struct CoarseImage {
    CoarseImage() = default;
    CoarseImage(ImageSize frame_size, int block_step, Channels channels);

    ImageSize size;  // the frame's
    int step = 1;
    Image image;                       // one pixel a block
    std::vector<std::uint8_t> broken;  // per block: 1 if it came out as no number
};

// Each block filled with its sample. Both have the same channels.
void fill_tile(const Image& blocks, int step, const Tile& tile, Image& image);

// If `pixel` of the frame is a block's sample: sets that number of the part to it and says true.
bool take_sample(const CoarseImage& coarse, Pixel pixel, TilePart& part, std::size_t number);

}  // namespace raypick
