// The rays of one frame: which go through a pixel, and what they bring back.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/geometry/camera.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/sampling_pattern.h"
#include "tracer/shade/batch_tracer.h"
#include "tracer/shade/settings.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// Throws Error if a number makes no sense: samples outside 1..64, contrast outside 0..1, a negative
// or endless aperture or focus distance or cutoff.
void check_settings(const RenderSettings& settings);

// A ray for one sample of a pixel.
struct SampleRay {
    EyeRay eye;
    bool negative = false;  // the filter is below 0 there
};

// What a frame is traced from; immutable while it is. All calls are thread-safe. Rays depend on the
// seed and the pixel alone, what they bring back on nothing else.
class PixelTracer {
public:
    // Throws Error on a bad camera, an empty size or bad settings.
    PixelTracer(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                const RenderSettings& settings);

    // Through the pixels' centres: the rays that picks follow.
    [[nodiscard]] EyeRayList centre_rays(std::span<const Pixel> pixels) const;
    // Through the pixel's top left corner; row and column may be one beyond the last pixel's.
    [[nodiscard]] EyeRay corner_ray(Pixel pixel) const;
    // Sample `index` of [0, sample_count()) of the stratified pattern.
    [[nodiscard]] SampleRay sample_ray(Pixel pixel, int index) const;
    [[nodiscard]] int sample_count() const { return pattern_.count(); }
    [[nodiscard]] const FilterSampler& filter() const { return pattern_.filter(); }

    // Sets the results, as many, to what `eyes` bring back, and adds the rays shot to `counts`.
    // Rays that lie side by side in the image should be so here. Once `stop` is requested the
    // results are worthless, if they are set at all.
    void trace(const EyeRays& eyes, TracedRays& results, RayCounts& counts,
               const std::stop_token& stop) const;
    // What they hit, without colour.
    void look(const EyeRays& eyes, TracedRays& results, const std::stop_token& stop) const;

    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] ImageSize size() const { return size_; }
    [[nodiscard]] const RenderSettings& settings() const { return settings_; }

private:
    [[nodiscard]] std::uint64_t seed_of(std::size_t ray) const;
    void trace(const ShadeScene& scene, const EyeRays& eyes, TracedRays& results, RayCounts& counts,
               const std::stop_token& stop) const;

    std::shared_ptr<const Accel> accel_;
    Camera camera_;
    ImageSize size_;
    RenderSettings settings_;
    RayGenerator rays_;
    std::vector<double> aside_;  // of each column's and row's pixel centres
    std::vector<double> above_;
    RayCone cone_;  // of a ray that stands for a whole pixel
    ShadeScene scene_;
    ShadeScene look_;  // without lights and further rays: no more than a look at the surface
    SamplingPattern pattern_;
    double focus_distance_;

    // Between calls, with the memory that they have got.
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<BatchTracer>> idle_;
};

}  // namespace raypick
