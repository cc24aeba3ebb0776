// trace(ray): the notes' recursive ray tracer.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/shade/eye_ray.h"
#include "tracer/shade/ray_counts.h"
#include "tracer/shade/settings.h"
#include "tracer/shade/shade_scene.h"

#include <span>
#include <stop_token>

namespace raypick {

// Follows an eye ray (depth 1) through the scene, recursively: the readable form of what
// BatchTracer does with many at once, bit for bit. Thread-safe; adds the rays it shot to `counts`.
// Glass may spawn 2^depth rays: once `stop` is requested no more are shot, and the result is
// worthless.
TracedRay trace(const ShadeScene& scene, const EyeRay& eye, RayCounts& counts,
                const std::stop_token& stop = {});
// The same with a ShadeScene for this one ray. `lights` as from effective_lights.
TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const EyeRay& eye, RayCounts& counts, const std::stop_token& stop = {});
// The same for a ray of no width.
TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const Ray& ray, RayCounts& counts, const std::stop_token& stop = {});

}  // namespace raypick
