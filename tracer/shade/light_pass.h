// The light of all lights on many points.
#pragma once

#include "tracer/accel/crossings.h"
#include "tracer/geometry/ray.h"
#include "tracer/shade/generation.h"
#include "tracer/shade/lit_points.h"
#include "tracer/shade/ray_counts.h"
#include "tracer/shade/shade_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace raypick {

// What trace() gathers at one point after the other, to the bit. Keeps its memory; one a thread.
class LightPass {
public:
    // The points are those at the ends of a generation's paths.
    struct Job {
        const ShadeScene& scene;
        const Generation& at;
        int depth = 1;  // the generation's
        RayCounts& counts;
        const std::stop_token& stop;
    };

    // Adds the light to the points. Once stop is requested they are worthless.
    void light(const Job& job, LitPoints& points);

private:
    void light_by(const Job& job, std::size_t light, int sample, LitPoints& points);
    static void shine(const Job& job, std::size_t light, int sample, LitPoints& points);
    void cast_shadows(const Job& job, const PreparedLight& light, LitPoints& points);
    void find_shares(const Job& job, const PreparedLight& light, LitPoints& points);
    void tint_shares(const Job& job, const PreparedLight& light, std::span<const Ray> rays,
                     LitPoints& points);

    // As many as there are points at least: the first shadow_count_ are in use.
    std::vector<Ray> shadow_rays_;
    std::vector<std::uint32_t> shadowed_;  // the points of these
    std::size_t shadow_count_ = 0;
    std::vector<std::uint8_t> blocked_;
    Crossings crossings_;
};

}  // namespace raypick
