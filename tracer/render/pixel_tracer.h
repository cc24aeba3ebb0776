// The rays of one frame: which go through a pixel, and what they bring back.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/geometry/camera.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/sampling_pattern.h"
#include "tracer/shade/settings.h"
#include "tracer/shade/trace.h"

#include <glm/vec3.hpp>

#include <memory>
#include <stop_token>
#include <vector>

namespace raypick {

// Throws Error if a number makes no sense: samples outside 1..64, contrast outside 0..1, a negative
// or endless aperture or focus distance or cutoff.
void check_settings(const RenderSettings& settings);

// What a frame is traced from; immutable while it is. All calls are thread-safe, add the rays they
// shot to `counts` and depend on the seed and the pixel alone.
class PixelTracer {
public:
    // Throws Error on a bad camera, an empty size or bad settings.
    PixelTracer(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                const RenderSettings& settings);

    // Along the ray through the pixel's centre, the one that a pick follows.
    [[nodiscard]] TracedRay centre(Pixel pixel, RayCounts& counts,
                                   const std::stop_token& stop) const;
    // What that ray hits, without colour; not counted.
    [[nodiscard]] TracedRay first_hit(Pixel pixel) const;
    // The colour along the ray through a pixel's top left corner; row and column may be one beyond
    // the last pixel's.
    [[nodiscard]] glm::vec3 corner(Pixel pixel, RayCounts& counts,
                                   const std::stop_token& stop) const;
    // Adds sample `index` of [0, sample_count()) of the stratified pattern.
    void add_sample(Pixel pixel, int index, PixelMean& mean, RayCounts& counts,
                    const std::stop_token& stop) const;
    [[nodiscard]] int sample_count() const { return pattern_.count(); }
    [[nodiscard]] const FilterSampler& filter() const { return pattern_.filter(); }

    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] ImageSize size() const { return size_; }
    [[nodiscard]] const RenderSettings& settings() const { return settings_; }

private:
    std::shared_ptr<const Accel> accel_;
    Camera camera_;
    ImageSize size_;
    RenderSettings settings_;
    RayGenerator rays_;
    std::vector<Light> lights_;
    SamplingPattern pattern_;
    double focus_distance_;
};

}  // namespace raypick
