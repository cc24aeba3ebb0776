// Rays through many points of an image at once.
#include "tracer/geometry/camera.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/geometry/camera_rays.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#ifndef RAYPICK_CAMERA_RAYS_ONCE
#define RAYPICK_CAMERA_RAYS_ONCE

namespace raypick {

// Some points of an image in a row, and the rays' directions and t_min there.
struct ImagePoints {
    static constexpr std::size_t kMost = 16;
    alignas(64) std::array<double, kMost> aside{};
    alignas(64) std::array<double, kMost> above{};
    alignas(64) std::array<std::array<float, kMost>, 3> direction{};
    alignas(64) std::array<float, kMost> t_min{};
};

}  // namespace raypick

#endif

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// RayGenerator::ray step by step, of a perspective view.
void aim_rays(const CameraFrame& frame, double near, ImagePoints& points, std::size_t count) {
    const hn::CappedTag<double, ImagePoints::kMost> d;
    const hn::Rebind<float, decltype(d)> f;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto aside = hn::Load(d, &points.aside[i]);
        const auto above = hn::Load(d, &points.above[i]);
        const auto along = [&](double vx, double vy, double vz) HWY_ATTR {
            const auto across =
                hn::Add(hn::Mul(aside, hn::Set(d, vx)), hn::Mul(above, hn::Set(d, vy)));
            return hn::Sub(across, hn::Set(d, vz));
        };
        const auto x = along(frame.vx.x, frame.vy.x, frame.vz.x);
        const auto y = along(frame.vx.y, frame.vy.y, frame.vz.y);
        const auto z = along(frame.vx.z, frame.vy.z, frame.vz.z);
        const auto length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
        hn::Store(hn::DemoteTo(f, hn::Div(x, length)), f, &points.direction[0][i]);
        hn::Store(hn::DemoteTo(f, hn::Div(y, length)), f, &points.direction[1][i]);
        hn::Store(hn::DemoteTo(f, hn::Div(z, length)), f, &points.direction[2][i]);
        hn::Store(hn::DemoteTo(f, hn::Mul(hn::Set(d, near), length)), f, &points.t_min[i]);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raypick {

HWY_EXPORT(aim_rays);

void RayGenerator::rays(std::span<const double> aside, std::span<const double> above,
                        std::span<Ray> rays) const {
    if (orthographic_) {
        for (std::size_t i = 0; i < rays.size(); ++i)
            rays[i] = ray(aside[i], above[i]);
        return;
    }
    const glm::vec3 origin(eye_);
    ImagePoints points;
    for (std::size_t first = 0; first < rays.size(); first += ImagePoints::kMost) {
        const std::size_t count = std::min(ImagePoints::kMost, rays.size() - first);
        std::copy_n(&aside[first], count, points.aside.begin());
        std::copy_n(&above[first], count, points.above.begin());
        HWY_DYNAMIC_DISPATCH(aim_rays)(frame_, near_, points, count);
        for (std::size_t i = 0; i < count; ++i) {
            Ray& ray = rays[first + i];
            ray.origin = origin;
            ray.direction.x = points.direction[0][i];
            ray.direction.y = points.direction[1][i];
            ray.direction.z = points.direction[2][i];
            ray.t_min = points.t_min[i];
            ray.t_max = std::numeric_limits<float>::infinity();
        }
    }
}

}  // namespace raypick

#endif  // HWY_ONCE
