#include "tracer/shade/batch_tracer.h"

#include "tracer/shade/shadow.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>

namespace raypick {

namespace {

// Rays of a generation that are there at the same time; their children are up to three times as
// many. Enough for groups that share a direction, and little enough to stay in a core's cache.
constexpr std::size_t kPortion = 1024;

constexpr std::size_t kOctants = 8;
constexpr std::size_t kDirections = 3 * kOctants;  // by kind of branch and octant

std::uint8_t direction_group(BranchKind kind, const glm::vec3& direction) {
    const unsigned octant = (direction.x < 0.0f ? 1u : 0u) | (direction.y < 0.0f ? 2u : 0u) |
                            (direction.z < 0.0f ? 4u : 0u);
    return static_cast<std::uint8_t>(kOctants * static_cast<std::size_t>(kind) + octant);
}

}  // namespace

void BatchTracer::Generation::put_inside(PathRay& ray, const Interior& interior) {
    if (ray.interior != kNoInterior) {
        interiors[ray.interior] = interior;
    } else if (!interior.empty()) {
        ray.interior = static_cast<std::uint32_t>(interiors.size());
        interiors.push_back(interior);
    }
}

BatchTracer::Generation& BatchTracer::generation(int depth) {
    const auto index = static_cast<std::size_t>(depth - 1);
    while (generations_.size() <= index)
        generations_.emplace_back();
    return generations_[index];
}

void BatchTracer::trace(const ShadeScene& scene, const EyeRays& eyes, std::span<TracedRay> results,
                        RayCounts& counts, const std::stop_token& stop) {
    const Job job{scene, eyes, results, counts, stop};
    begin(eyes);
    counts.eye += eyes.size();
    follow(job, 1);
    const LargeArray<PathRay>& rays = generation(1).rays;
    for (std::size_t i = 0; i < rays.size(); ++i)
        results[i].colour = rays[i].passed * rays[i].colour;
}

void BatchTracer::begin(const EyeRays& eyes) {
    Generation& first = generation(1);
    first.interiors.clear();
    first.rays.resize(eyes.size());
    for (std::size_t i = 0; i < eyes.size(); ++i)  // rays, shares and directions have no use here
        set_begun(first.rays[i], static_cast<std::uint32_t>(i), eyes.cone, 1.0f, eyes.seed(i));
}

void BatchTracer::set_begun(PathRay& path, std::uint32_t parent, const RayCone& cone, float weight,
                            std::uint64_t seed) {
    path.parent = parent;
    path.cone = cone;
    path.weight = weight;
    path.seed = seed;
    path.interior = kNoInterior;
    path.passed = glm::vec3(1.0f);
    path.colour = glm::vec3(0.0f);
}

// Brings back what comes along all rays of a generation.
void BatchTracer::follow(const Job& job, int depth) {
    const Step step{job, depth, generation(depth), generation(depth + 1)};
    std::vector<std::uint32_t>& order = step.at.order;
    order.resize(step.at.rays.size());
    if (depth == 1) {  // as they come
        std::iota(order.begin(), order.end(), 0u);
    } else {
        std::array<std::uint32_t, kDirections + 1> place{};
        for (const PathRay& ray : step.at.rays)
            ++place[ray.direction + std::size_t{1}];
        std::partial_sum(place.begin(), place.end(), place.begin());
        for (std::uint32_t i = 0; i < step.at.rays.size(); ++i)
            order[place[step.at.rays[i].direction]++] = i;
    }
    for (std::size_t first = 0; first < order.size(); first += kPortion) {
        if (job.stop.stop_requested()) return;
        const std::size_t count = std::min(kPortion, order.size() - first);
        follow_portion(step, std::span(order).subspan(first, count));
    }
}

void BatchTracer::follow_portion(const Step& step, std::span<const std::uint32_t> portion) {
    load_rays(step, portion);
    step.next.rays.clear();
    step.next.interiors.clear();
    find_points(step);
    send_mirrored(step);
    light_points(step);
    if (step.next.rays.empty()) return;
    follow(step.job, step.depth + 1);
    // In the order in which they left.
    for (const PathRay& ray : step.next.rays)
        step.at.rays[ray.parent].colour += ray.share * (ray.passed * ray.colour);
}

void BatchTracer::load_rays(const Step& step, std::span<const std::uint32_t> portion) {
    at_work_.assign(portion.begin(), portion.end());
    rays_.resize(portion.size());
    directions_.assign(portion.size(), 0);
    if (step.depth == 1) {
        const std::span<const Ray> eyes = step.job.eyes.rays;  // as they come
        std::copy_n(&eyes[portion.front()], portion.size(), rays_.begin());
        return;
    }
    for (std::size_t i = 0; i < portion.size(); ++i) {
        rays_[i] = step.at.rays[portion[i]].ray;
        directions_[i] = step.at.rays[portion[i]].direction;
    }
}

// Follows the rays at work to where they end, through surfaces that are hidden inside of glass of a
// higher priority, and sends on the next generation.
void BatchTracer::find_points(const Step& step) {
    points_.clear();
    mirrored_.clear();
    for (int hidden = 0; !at_work_.empty(); ++hidden) {
        if (step.job.stop.stop_requested()) return;
        intersect_groups(step);
        if (step.depth == 1 && hidden == 0) note_first_hits(step.job);
        found_.resize(rays_.size());
        find_surfaces(step.job.scene, rays_, hits_, found_, surfaces_);
        std::size_t left = 0;
        for (std::size_t i = 0; i < at_work_.size(); ++i) {
            if (!hits_[i].valid()) {
                see_sky(step, step.at.rays[at_work_[i]], rays_[i]);
                continue;
            }
            if (!arrive(step, hidden, i)) continue;
            at_work_[left] = at_work_[i];
            directions_[left] = directions_[i];
            rays_[left++] = rays_[i];
        }
        at_work_.resize(left);
        directions_.resize(left);
        rays_.resize(left);
    }
}

// One query for each group of rays that go the same way.
void BatchTracer::intersect_groups(const Step& step) {
    const ShadeScene& scene = step.job.scene;
    RayQuery query;
    query.uv = scene.has_maps;
    hits_.resize(rays_.size());
    for (std::size_t first = 0; first < rays_.size();) {
        std::size_t end = first + 1;
        while (end < rays_.size() && directions_[end] == directions_[first])
            ++end;
        scene.accel->intersect(std::span(rays_).subspan(first, end - first),
                               std::span(hits_).subspan(first, end - first), query);
        first = end;
    }
}

void BatchTracer::note_first_hits(const Job& job) {
    for (std::size_t i = 0; i < hits_.size(); ++i) {
        TracedRay& result = job.results[at_work_[i]];
        result.hit = hits_[i];
        result.normal = glm::vec3(0.0f);
        job.counts.eye_hits += hits_[i].valid() ? 1 : 0;
    }
}

// What ray i of those at work, which hits something, brings back by itself. True: it goes on, since
// the surface is hidden.
bool BatchTracer::arrive(const Step& step, int hidden, std::size_t i) {
    PathRay& path = step.at.rays[at_work_[i]];
    const ShadeScene& scene = step.job.scene;
    const Hit& hit = hits_[i];
    const Ray& ray = rays_[i];
    const FoundHit& found = found_[i];
    const Boundary boundary = boundary_at(scene, found, hit, step.at.interior_of(path), crossing_);
    if (boundary.medium != kNoMaterial) path.passed *= passed(scene, boundary.medium, hit.t);
    path.cone.width = path.cone.at(hit.t);
    if (!boundary.is_there && hidden < kMostHidden) {
        step.at.put_inside(path, boundary.crossing->after);
        rays_[i] = Ray{offset_origin(found.surface, ray.direction), ray.direction};
        return true;
    }
    if (boundary.crossing != nullptr) step.at.put_inside(path, boundary.crossing->before);
    path.weight *= largest(path.passed);
    const ShadingPoint point =
        shading_point(scene, found, ray.direction, path.cone.width, &with_maps_);
    points_.add(
        at_work_[i], point,
        found.material->has_maps ? own_light(*scene.scene, point.material) : found.material->own);
    if (step.depth == 1) step.job.results[path.parent].normal = point.normal;
    if (!found.material->branches || step.depth >= scene.settings.depth) return false;
    if (found.material->only_mirrors) {
        want_mirrored(step, at_work_[i], *found.material);
    } else {
        const ShadingPoint in_memory(point);  // lets `point` stay in registers
        send_branches(step, at_work_[i], in_memory, boundary);
    }
    return false;
}

void BatchTracer::see_sky(const Step& step, PathRay& path, const Ray& ray) {
    const ShadeScene& scene = step.job.scene;
    path.colour = sky_colour(scene, ray.direction, path.cone.spread);
    if (const Interior* interior = step.at.interior_of(path)) {
        path.colour *= passed(scene, interior->medium(*scene.scene), ray.t_max);
    }
}

// Rays of the next generation.
void BatchTracer::send_branches(const Step& step, std::uint32_t from, const ShadingPoint& point,
                                const Boundary& boundary) {
    const PathRay& path = step.at.rays[from];
    const ShadeScene& scene = step.job.scene;
    find_branches(scene, point, boundary, path.weight, branches_);
    for (std::size_t i = 0; i < branches_.count; ++i) {
        const Branch& branch = branches_.branch[i];
        count_branch(step.job.counts, branch.kind, step.depth + 1);
        PathRay& onwards = step.next.add();
        set_leaving(point, branch.direction, onwards.ray);
        onwards.ray.t_min = 0.0f;
        onwards.ray.t_max = std::numeric_limits<float>::infinity();
        onwards.share = branch.share;
        set_begun(onwards, from, path.cone, branch.weight,
                  branch_seed(scene, path.seed, branch.kind));
        onwards.direction = direction_group(branch.kind, branch.direction);
        if (branch.kind == BranchKind::transmitted && boundary.crossing != nullptr) {
            step.next.put_inside(onwards, boundary.crossing->after);
        } else if (path.interior != kNoInterior) {
            step.next.put_inside(onwards, step.at.interiors[path.interior]);
        }
    }
}

// What find_branches would say of the latest point, on a surface that only mirrors.
void BatchTracer::want_mirrored(const Step& step, std::uint32_t from,
                                const PreparedMaterial& material) {
    const float weight = step.at.rays[from].weight * largest(material.mirrored);
    const float cutoff = step.job.scene.settings.cutoff;
    if (cutoff != 0.0f && !(weight > cutoff)) return;
    const std::size_t point = points_.size() - 1;
    points_.want_mirrored(point);
    mirrored_.push_back({&material, static_cast<std::uint32_t>(point), weight});
}

// More rays of the next generation.
void BatchTracer::send_mirrored(const Step& step) {
    if (mirrored_.empty()) return;
    points_.mirror();
    for (const Mirrored& mirrored : mirrored_) {
        const std::uint32_t from = points_.ray(mirrored.point);
        const PathRay& path = step.at.rays[from];
        count_branch(step.job.counts, BranchKind::mirrored, step.depth + 1);
        PathRay& onwards = step.next.add();
        points_.take_mirrored(mirrored.point, onwards.ray);
        onwards.share = mirrored.material->mirrored;
        set_begun(onwards, from, path.cone, mirrored.weight,
                  branch_seed(step.job.scene, path.seed, BranchKind::mirrored));
        onwards.direction = direction_group(BranchKind::mirrored, onwards.ray.direction);
        if (path.interior != kNoInterior) {
            step.next.put_inside(onwards, step.at.interiors[path.interior]);
        }
    }
}

// One light after the other, so that rays to the same light travel together.
void BatchTracer::light_points(const Step& step) {
    const std::vector<PreparedLight>& lights = step.job.scene.lights;
    if (step.job.scene.settings.shadows) points_.leave_surfaces();
    for (std::size_t light = 0; light < lights.size() && points_.size() != 0; ++light) {
        for (int sample = 0; sample < lights[light].count(); ++sample) {
            if (step.job.stop.stop_requested()) return;
            light_points_by(step, light, sample);
        }
    }
    for (std::size_t i = 0; i < points_.size(); ++i)
        step.at.rays[points_.ray(i)].colour = points_.colour(i);
}

void BatchTracer::light_points_by(const Step& step, std::size_t light, int sample) {
    const bool shadows = step.job.scene.settings.shadows;
    shine(step, light, sample);
    points_.face_light(shadows);
    if (shadows) cast_shadows(step, step.job.scene.lights[light]);
    points_.gather();
}

void BatchTracer::shine(const Step& step, std::size_t light, int sample) {
    const ShadeScene& scene = step.job.scene;
    const PreparedLight& source = scene.lights[light];
    if (LitPoints::at_once(source)) {
        points_.shine(source);
        return;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const std::uint64_t seed = light_seed(scene, step.at.rays[points_.ray(i)].seed, light);
        points_.shine(i, light_sample(source, points_.position(i), sample, seed));
    }
}

void BatchTracer::cast_shadows(const Step& step, const PreparedLight& light) {
    if (shadow_rays_.size() < points_.size()) {
        shadow_rays_.resize(points_.size());
        shadowed_.resize(points_.size());
    }
    shadow_count_ = points_.take_shadow_rays(shadow_rays_, shadowed_);
    find_shares(step, light);
    std::size_t blocked = 0;
    for (std::size_t i = 0; i < shadow_count_; ++i) {
        if (blocked_[i] == 0) continue;
        points_.block(shadowed_[i]);
        ++blocked;
    }
    step.job.counts.shadow_blocked += blocked;
}

// What arrives of the light along the shadow rays, which all end at it.
void BatchTracer::find_shares(const Step& step, const PreparedLight& light) {
    const ShadeScene& scene = step.job.scene;
    const std::span<const Ray> rays = std::span(shadow_rays_).first(shadow_count_);
    count_shadows(step.job.counts, rays.size(), step.depth);
    if (scene.tints_shadows()) {
        tint_shares(step, light, rays);
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
void BatchTracer::tint_shares(const Step& step, const PreparedLight& light,
                              std::span<const Ray> rays) {
    const ShadeScene& scene = step.job.scene;
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
        const PathRay& path = step.at.rays[points_.ray(shadowed_[i])];
        const Interior* interior = step.at.interior_of(path);
        if (crossings_.of(i).empty() && interior == nullptr) continue;
        const glm::vec3 share =
            transmittance_through(scene, rays[i], crossings_.of(i), interior, path.cone.width);
        blocked_[i] = share == glm::vec3(0.0f) ? 1 : 0;
        points_.tint(shadowed_[i], share);
    }
}

}  // namespace raypick
