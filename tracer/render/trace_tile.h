// A tile's rays: from pixels to a part of the image. No threads and no locks here.
#pragma once

#include "tracer/render/coarse_image.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/pixel_tracer.h"
#include "tracer/render/tiles.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace raypick {

// What follows is worthless once `stop` is requested, if it is set at all.

// One ray for each block of `step` x `step` pixels, of a tile of the coarse image.
void trace_blocks(const PixelTracer& tracer, int step, TilePart& part, const std::stop_token& stop);

// One ray through each pixel's centre, but for those that `coarse` knows already (nullptr: none).
void trace_centres(const PixelTracer& tracer, const CoarseImage* coarse, TilePart& part,
                   const std::stop_token& stop);

// The mean of the rays through each pixel's corners, and what its centre shows in all channels but
// the colour. Corners that two tiles share are traced by both, which costs a sixteenth, and counted
// by one.
void trace_corners(const PixelTracer& tracer, TilePart& part, const std::stop_token& stop);

// Sets all channels but the colour to what the pixels' centres show, if the part has them.
void look_at_centres(const PixelTracer& tracer, TilePart& part, const std::stop_token& stop);

// Adds one of the pattern's samples of each of these pixels, the tile's own, to its sum.
void add_samples(const PixelTracer& tracer, const Tile& tile, const std::vector<Pixel>& pixels,
                 int sample, std::vector<PixelMean>& sums, RayCounts& counts,
                 const std::stop_token& stop);

}  // namespace raypick
