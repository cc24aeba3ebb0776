// trace(ray): the notes' recursive ray tracer.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"
#include "tracer/shade/settings.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>

namespace raypick {

// Of RenderSettings::depth.
inline constexpr int kMaxDepth = 64;

// Rays by kind. Sums over pixels: the same for any number of threads.
struct RayCounts {
    std::uint64_t eye = 0;
    std::uint64_t eye_hits = 0;
    std::uint64_t reflection = 0;
    std::uint64_t refraction = 0;
    std::uint64_t shadow = 0;
    std::uint64_t shadow_blocked = 0;
    // The same by depth: of the ray that arrives (an eye ray is depth 1), or for shadow rays of the
    // ray whose hit they start from.
    std::array<std::uint64_t, kMaxDepth + 1> reflection_at{};
    std::array<std::uint64_t, kMaxDepth + 1> refraction_at{};
    std::array<std::uint64_t, kMaxDepth + 1> shadow_at{};

    [[nodiscard]] std::uint64_t total() const { return eye + reflection + refraction + shadow; }
    RayCounts& operator+=(const RayCounts& other);
    friend bool operator==(const RayCounts&, const RayCounts&) = default;
};

// One traced eye ray: the colour and, for the frame's other channels, what was hit first.
struct TracedRay {
    glm::vec3 colour{0.0f};  // linear RGB
    Hit hit;                 // invalid: background
    glm::vec3 normal{0.0f};  // shading normal towards the eye, scene space; 0 on a miss
};

// An eye ray with what it stands for.
struct EyeRay {
    Ray ray;
    RayCone cone;            // for texture filtering
    std::uint64_t seed = 0;  // of all that is random on its way (points on area lights)
};

// Follows an eye ray (depth 1) through the scene. `lights` as from effective_lights. Thread-safe;
// adds the rays it shot to `counts`. Glass may spawn 2^depth rays: once `stop` is requested no more
// are shot, and the result is worthless.
TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const EyeRay& eye, RayCounts& counts, const std::stop_token& stop = {});
// The same for a ray of no width.
TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const Ray& ray, RayCounts& counts, const std::stop_token& stop = {});

}  // namespace raypick
