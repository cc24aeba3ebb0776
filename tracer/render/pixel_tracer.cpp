#include "tracer/render/pixel_tracer.h"

#include "tracer/error.h"
#include "tracer/shade/random.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace raypick {

namespace {

bool finite_and_not_negative(double number) {
    return number >= 0.0 && std::isfinite(number);
}

// Before any of it is used.
const RenderSettings& checked(const RenderSettings& settings, const Camera& camera,
                              ImageSize size) {
    check_camera(camera);
    check_settings(settings);
    if (size.rows <= 0 || size.cols <= 0) throw Error("an image needs at least one row and column");
    return settings;
}

// A pixel's share of what a whole pixel covers when it takes side x side rays.
RayCone part_of(const RayCone& cone, int side) {
    const auto parts = static_cast<float>(side);
    return {cone.width / parts, cone.spread / parts};
}

// The same look at the surface that traced rays have, and no more.
RenderSettings only_a_look() {
    RenderSettings settings;
    settings.depth = 1;
    return settings;
}

}  // namespace

void check_settings(const RenderSettings& settings) {
    if (settings.samples < 1 || settings.samples > 64) {
        throw Error("samples: must be from 1 to 64 along each side of a pixel");
    }
    if (!(settings.contrast >= 0.0f && settings.contrast <= 1.0f)) {
        throw Error("contrast: must be from 0 to 1");
    }
    if (!finite_and_not_negative(settings.aperture)) {
        throw Error("aperture: must be 0 or a positive number");
    }
    if (!finite_and_not_negative(settings.focus_distance)) {
        throw Error("focus_distance: must be 0 or a positive number");
    }
    if (!finite_and_not_negative(static_cast<double>(settings.cutoff))) {
        throw Error("cutoff: must be 0 or a positive number");
    }
}

PixelTracer::PixelTracer(std::shared_ptr<const Accel> accel, const Camera& camera, ImageSize size,
                         const RenderSettings& settings)
    : accel_(std::move(accel)),
      camera_(camera),
      size_(size),
      settings_(checked(settings, camera, size)),
      rays_(camera, size),
      cone_(rays_.cone()),
      scene_(shade_scene(*accel_, effective_lights(accel_->scene(), camera), settings)),
      look_(shade_scene(*accel_, {}, only_a_look())),
      pattern_(settings),
      focus_distance_(settings.focus_distance > 0.0 ? settings.focus_distance
                                                    : glm::distance(camera.eye, camera.at)) {
    for (int col = 0; col < size.cols; ++col)
        aside_.push_back(rays_.aside(pixel_centre({0, col}).c));
    for (int row = 0; row < size.rows; ++row)
        above_.push_back(rays_.above(pixel_centre({row, 0}).r));
}

// Nothing else is random on the way of a ray than points on lights.
std::uint64_t PixelTracer::seed_of(std::size_t ray) const {
    return scene_.draws_lots ? RandomSequence::derive(settings_.seed, ray) : 0;
}

EyeRayList PixelTracer::centre_rays(std::span<const Pixel> pixels) const {
    constexpr std::size_t kAtOnce = 64;
    std::array<double, kAtOnce> aside{};
    std::array<double, kAtOnce> above{};
    EyeRayList eyes;
    eyes.cone = cone_;
    eyes.rays.resize(pixels.size());
    for (std::size_t first = 0; first < pixels.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, pixels.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            aside[i] = aside_[static_cast<std::size_t>(pixels[first + i].col)];
            above[i] = above_[static_cast<std::size_t>(pixels[first + i].row)];
        }
        rays_.rays(std::span(aside).first(count), std::span(above).first(count),
                   std::span(eyes.rays).subspan(first, count));
    }
    if (scene_.draws_lots) {
        for (const Pixel& pixel : pixels)
            eyes.seeds.push_back(seed_of(size_.index(pixel)));
    }
    return eyes;
}

EyeRay PixelTracer::corner_ray(Pixel pixel) const {
    const ImageSize corners{size_.rows + 1, size_.cols + 1};
    const ImagePoint point{static_cast<double>(pixel.row), static_cast<double>(pixel.col)};
    return {rays_.ray(point), cone_, seed_of(corners.index(pixel))};
}

SampleRay PixelTracer::sample_ray(Pixel pixel, int index) const {
    const PixelSample sample = pattern_.sample(size_.index(pixel), index);
    const ImagePoint centre = pixel_centre(pixel);
    const ImagePoint point{centre.r + sample.offset.y, centre.c + sample.offset.x};
    const glm::dvec2 lens = 0.5 * settings_.aperture * sample.lens;
    const Ray ray =
        settings_.aperture > 0.0 ? rays_.lens_ray(point, lens, focus_distance_) : rays_.ray(point);
    return {{ray, part_of(cone_, settings_.samples), sample.seed}, sample.negative};
}

void PixelTracer::trace(const EyeRays& eyes, TracedRays& results, RayCounts& counts,
                        const std::stop_token& stop) const {
    trace(scene_, eyes, results, counts, stop);
}

void PixelTracer::look(const EyeRays& eyes, TracedRays& results,
                       const std::stop_token& stop) const {
    RayCounts not_counted;
    trace(look_, eyes, results, not_counted, stop);
}

void PixelTracer::trace(const ShadeScene& scene, const EyeRays& eyes, TracedRays& results,
                        RayCounts& counts, const std::stop_token& stop) const {
    std::unique_ptr<BatchTracer> tracer;
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            tracer = std::move(idle_.back());
            idle_.pop_back();
        }
    }
    if (!tracer) tracer = std::make_unique<BatchTracer>();
    tracer->trace(scene, eyes, results, counts, stop);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(tracer));
}

}  // namespace raypick
