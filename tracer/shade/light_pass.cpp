#include "tracer/shade/light_pass.h"

#include "tracer/shade/branches.h"
#include "tracer/shade/light_sample.h"
#include "tracer/shade/shadow.h"

namespace raypick {

// One light after the other, so that rays to the same light travel together.
void LightPass::light(const Job& job, LitPoints& points) {
    const std::vector<PreparedLight>& lights = job.scene.lights;
    if (job.scene.settings.shadows) points.leave_surfaces();
    for (std::size_t light = 0; light < lights.size() && points.size() != 0; ++light) {
        for (int sample = 0; sample < lights[light].count(); ++sample) {
            if (job.stop.stop_requested()) return;
            light_by(job, light, sample, points);
        }
    }
}

void LightPass::light_by(const Job& job, std::size_t light, int sample, LitPoints& points) {
    const bool shadows = job.scene.settings.shadows;
    shine(job, light, sample, points);
    points.face_light(shadows);
    if (shadows) cast_shadows(job, job.scene.lights[light], points);
    points.gather();
}

void LightPass::shine(const Job& job, std::size_t light, int sample, LitPoints& points) {
    const ShadeScene& scene = job.scene;
    const PreparedLight& source = scene.lights[light];
    if (LitPoints::at_once(source)) {
        points.shine(source);
        return;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!points.holds(i)) continue;
        const std::uint64_t seed = light_seed(scene, job.at.paths[points.ray(i)].seed, light);
        points.shine(i, light_sample(source, points.position(i), sample, seed));
    }
}

void LightPass::cast_shadows(const Job& job, const PreparedLight& light, LitPoints& points) {
    if (shadow_rays_.size() < points.size()) {
        shadow_rays_.resize(points.size());
        shadowed_.resize(points.size());
    }
    shadow_count_ = points.take_shadow_rays(shadow_rays_, shadowed_);
    find_shares(job, light, points);
    std::size_t blocked = 0;
    for (std::size_t i = 0; i < shadow_count_; ++i) {
        if (blocked_[i] == 0) continue;
        points.block(shadowed_[i]);
        ++blocked;
    }
    job.counts.shadow_blocked += blocked;
}

// What arrives of the light along the shadow rays, which all end at it.
void LightPass::find_shares(const Job& job, const PreparedLight& light, LitPoints& points) {
    const ShadeScene& scene = job.scene;
    const std::span<const Ray> rays = std::span(shadow_rays_).first(shadow_count_);
    count_shadows(job.counts, rays.size(), job.depth);
    if (scene.tints_shadows()) {
        tint_shares(job, light, rays, points);
        return;
    }
    blocked_.resize(rays.size());
    if (light.is_a_point()) {
        scene.accel->occluded_towards(glm::vec3(light.position), rays, blocked_);
    } else {
        scene.accel->occluded(rays, blocked_);
    }
}

// Light goes through glass: of the rays that nothing else blocks, what is left by it.
void LightPass::tint_shares(const Job& job, const PreparedLight& light, std::span<const Ray> rays,
                            LitPoints& points) {
    const ShadeScene& scene = job.scene;
    RayQuery query;
    query.uv = scene.has_maps;
    if (light.is_a_point()) {
        scene.accel->cross_towards(glm::vec3(light.position), rays, scene.clear, crossings_, query);
    } else {
        scene.accel->cross(rays, scene.clear, crossings_, query);
    }
    blocked_ = crossings_.blocked;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (blocked_[i] != 0) continue;
        const RayPath& path = job.at.paths[points.ray(shadowed_[i])];
        const Interior* interior = job.at.interior_of(path);
        if (crossings_.of(i).empty() && interior == nullptr) continue;
        const glm::vec3 share =
            transmittance_through(scene, rays[i], crossings_.of(i), interior, path.cone.width);
        blocked_[i] = share == glm::vec3(0.0f) ? 1 : 0;
        points.tint(shadowed_[i], share);
    }
}

}  // namespace raypick
