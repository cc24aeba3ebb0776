// Does the rasterised frame have the colours that the tracer gives without shadows and further
// rays? Pixel by pixel, where both see the same primitive.
#pragma once

#include "tests/agreement.h"
#include "tracer/render/image.h"
#include "tracer/scene/scene.h"
#include "tracer/shade/trace.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <vector>

namespace raypick {

// The same local light that the raster view has: no shadows, no further rays.
inline RenderSettings local_light_only() {
    RenderSettings settings;
    settings.shadows = settings.reflections = settings.refractions = false;
    return settings;
}

// The traced frame, one ray through each pixel's centre.
inline Image trace_local(const Accel& accel, const Camera& camera, ImageSize size) {
    const RayGenerator generator(camera, size);
    const std::vector<Light> lights = effective_lights(accel.scene(), camera);
    Image image = make_image(size);
    RayCounts counts;
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const std::size_t i = size.index({row, col});
            const EyeRay eye{generator.ray(pixel_centre({row, col})), generator.cone(), i};
            const TracedRay traced = trace(accel, lights, local_light_only(), eye, counts);
            image.colour[i] = traced.colour;
            image.normal[i] = traced.normal;
            image.object[i] = traced.hit.valid() ? traced.hit.object : kNoObject;
            image.primitive[i] = traced.hit.valid() ? traced.hit.primitive : 0xffffffffu;
        }
    }
    return image;
}

struct ColourAgreement {
    std::size_t pixels = 0;     // compared
    double mean = 0.0;          // absolute difference of a channel
    double largest = 0.0;       // of a pixel's worst channel
    double share_beyond = 0.0;  // of the pixels with a channel off by more than the tolerance
    double contrast = 0.0;      // mean absolute deviation of the traced picture from its own mean
    Pixel worst{0, 0};

    [[nodiscard]] std::string summary() const {
        return fmt::format(
            "{} pixels, mean {:.2e}, {:.3f} % beyond the tolerance, largest {:.2e} at row {} col "
            "{}, contrast {:.2e}",
            pixels, mean, 100.0 * share_beyond, largest, worst.row, worst.col, contrast);
    }
};

inline double channel_mean(const glm::vec3& v) {
    return (static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z)) / 3.0;
}

// A pixel counts as different if a channel is off by more than `tolerance`. Compared are the pixels
// where object and primitive are the same.
inline ColourAgreement compare_colours(const Image& traced, const Image& raster, float tolerance) {
    ColourAgreement result;
    std::vector<double> values;
    double sum = 0.0;
    double total = 0.0;
    std::size_t beyond = 0;
    for (int row = 0; row < traced.size.rows; ++row) {
        for (int col = 0; col < traced.size.cols; ++col) {
            const std::size_t i = traced.size.index({row, col});
            if (traced.object[i] != raster.object[i] || traced.primitive[i] != raster.primitive[i])
                continue;
            const glm::vec3 d = glm::abs(traced.colour[i] - raster.colour[i]);
            const float off = std::max(d.x, std::max(d.y, d.z));
            if (!(off <= tolerance)) ++beyond;  // NaN is beyond
            if (!(static_cast<double>(off) <= result.largest)) {
                result.largest = static_cast<double>(off);
                result.worst = {row, col};
            }
            sum += channel_mean(d);
            values.push_back(channel_mean(traced.colour[i]));
            total += values.back();
        }
    }
    result.pixels = values.size();
    if (values.empty()) return result;
    const auto n = static_cast<double>(values.size());
    result.mean = sum / n;
    result.share_beyond = static_cast<double>(beyond) / n;
    for (const double value : values)
        result.contrast += std::abs(value - total / n) / n;
    return result;
}

}  // namespace raypick
