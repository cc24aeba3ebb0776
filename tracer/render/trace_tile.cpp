#include "tracer/render/trace_tile.h"

#include <cstddef>

namespace raypick {

namespace {

EyeRayList centre_rays(const PixelTracer& tracer, const Tile& tile, std::vector<Pixel> pixels) {
    for (Pixel& pixel : pixels)
        pixel = tile.in_image(pixel);
    return tracer.centre_rays(pixels);
}

// The colours at the corners of the tile's pixels.
std::vector<glm::vec3> corner_colours(const PixelTracer& tracer, const Tile& tile,
                                      RayCounts& counts, const std::stop_token& stop) {
    const ImageSize size = tile.size();
    const ImageSize corners{size.rows + 1, size.cols + 1};
    std::vector<glm::vec3> colours(corners.pixel_count());
    RayCounts not_counted;
    for (const bool own : {true, false}) {
        std::vector<std::size_t> places;
        EyeRayList eyes;
        for (const Pixel& pixel : pixels_in_squares(corners)) {
            const Pixel corner = tile.in_image(pixel);
            const bool is_own = (pixel.row < size.rows || corner.row == tracer.size().rows) &&
                                (pixel.col < size.cols || corner.col == tracer.size().cols);
            if (is_own != own) continue;
            places.push_back(corners.index(pixel));
            eyes.add(tracer.corner_ray(corner));
        }
        TracedRays traced(places.size(), false);
        tracer.trace(eyes.all(), traced, own ? counts : not_counted, stop);
        for (std::size_t i = 0; i < places.size(); ++i)
            colours[places[i]] = traced.colours[i];
    }
    return colours;
}

}  // namespace

void trace_blocks(const PixelTracer& tracer, int step, TilePart& part,
                  const std::stop_token& stop) {
    const std::vector<Pixel> blocks = pixels_in_squares(part.image.size);
    std::vector<Pixel> samples;
    samples.reserve(blocks.size());
    for (const Pixel& block : blocks)
        samples.push_back(block_sample(part.tile.in_image(block), step, tracer.size()));
    TracedRays traced(blocks.size(), part.has_all());
    tracer.trace(tracer.centre_rays(samples).all(), traced, part.rays, stop);
    if (stop.stop_requested()) return;
    for (std::size_t i = 0; i < blocks.size(); ++i)
        part.set(part.image.size.index(blocks[i]), traced, i);
}

void trace_centres(const PixelTracer& tracer, const CoarseImage* coarse, TilePart& part,
                   const std::stop_token& stop) {
    const Tile& tile = part.tile;
    std::vector<Pixel> pixels = pixels_in_squares(part.image.size);
    if (coarse != nullptr) {
        std::erase_if(pixels, [&](const Pixel& pixel) {
            return take_sample(*coarse, tile.in_image(pixel), part, part.image.size.index(pixel));
        });
    }
    TracedRays traced(pixels.size(), part.has_all());
    tracer.trace(centre_rays(tracer, tile, pixels).all(), traced, part.rays, stop);
    if (stop.stop_requested()) return;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        part.set(part.image.size.index(pixels[i]), traced, i);
}

void look_at_centres(const PixelTracer& tracer, TilePart& part, const std::stop_token& stop) {
    if (!part.has_all()) return;
    const std::vector<Pixel> pixels = pixels_in_squares(part.image.size);
    TracedRays seen(pixels.size(), true);
    tracer.look(centre_rays(tracer, part.tile, pixels).all(), seen, stop);
    if (stop.stop_requested()) return;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        part.set_hit(part.image.size.index(pixels[i]), seen.hits[i], seen.normals[i]);
}

void trace_corners(const PixelTracer& tracer, TilePart& part, const std::stop_token& stop) {
    const ImageSize size = part.image.size;
    const ImageSize corners{size.rows + 1, size.cols + 1};
    const std::vector<glm::vec3> colours = corner_colours(tracer, part.tile, part.rays, stop);
    look_at_centres(tracer, part, stop);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            part.set_colour(size.index({row, col}),
                            0.25f * (colours[corners.index({row, col})] +
                                     colours[corners.index({row, col + 1})] +
                                     colours[corners.index({row + 1, col})] +
                                     colours[corners.index({row + 1, col + 1})]));
        }
    }
}

void add_samples(const PixelTracer& tracer, const Tile& tile, const std::vector<Pixel>& pixels,
                 int sample, std::vector<PixelMean>& sums, RayCounts& counts,
                 const std::stop_token& stop) {
    EyeRayList eyes;
    std::vector<std::uint8_t> negative;
    for (const Pixel& pixel : pixels) {
        const SampleRay ray = tracer.sample_ray(tile.in_image(pixel), sample);
        eyes.add(ray.eye);
        negative.push_back(ray.negative ? 1 : 0);
    }
    TracedRays traced(pixels.size(), false);
    tracer.trace(eyes.all(), traced, counts, stop);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        sums[i].add(traced.colours[i], negative[i] != 0);
}

}  // namespace raypick
