#include "tracer/shade/batch_tracer.h"

#include "tracer/shade/shadow.h"

#include <algorithm>
#include <array>
#include <cstddef>
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

void BatchTracer::trace(const ShadeScene& scene, std::span<const EyeRay> eyes,
                        std::span<TracedRay> results, RayCounts& counts,
                        const std::stop_token& stop) {
    const Job job{scene, results, counts, stop};
    Generation& first = generation(1);
    first.rays.resize(eyes.size());
    first.interiors.clear();
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        PathRay path;
        path.ray = eyes[i].ray;
        path.parent = static_cast<std::uint32_t>(i);
        path.cone = eyes[i].cone;
        path.seed = eyes[i].seed;
        first.rays[i] = path;
        results[i] = {};
    }
    counts.eye += eyes.size();
    follow(job, 1);
    for (std::size_t i = 0; i < eyes.size(); ++i)
        results[i].colour = first.rays[i].passed * first.rays[i].colour;
}

// Brings back what comes along all rays of a generation.
void BatchTracer::follow(const Job& job, int depth) {
    Generation& at = generation(depth);
    std::array<std::uint32_t, kDirections + 1> place{};
    for (const PathRay& ray : at.rays)
        ++place[ray.direction + std::size_t{1}];
    std::partial_sum(place.begin(), place.end(), place.begin());
    at.order.resize(at.rays.size());
    for (std::uint32_t i = 0; i < at.rays.size(); ++i)
        at.order[place[at.rays[i].direction]++] = i;
    for (std::size_t first = 0; first < at.order.size(); first += kPortion) {
        if (job.stop.stop_requested()) return;
        const std::size_t count = std::min(kPortion, at.order.size() - first);
        follow_portion(job, depth, std::span(at.order).subspan(first, count));
    }
}

void BatchTracer::follow_portion(const Job& job, int depth,
                                 std::span<const std::uint32_t> portion) {
    Generation& at = generation(depth);
    at_work_.assign(portion.begin(), portion.end());
    rays_.clear();
    directions_.clear();
    for (const std::uint32_t i : portion) {
        rays_.push_back(at.rays[i].ray);
        directions_.push_back(at.rays[i].direction);
    }
    Generation& next = generation(depth + 1);
    next.rays.clear();
    next.interiors.clear();
    find_points(job, depth);
    light_points(job, depth);
    if (next.rays.empty()) return;
    follow(job, depth + 1);
    collect(depth);
}

// Adds what the next generation brought back to the points that it left from.
void BatchTracer::collect(int depth) {
    std::vector<PathRay>& rays = generation(depth).rays;
    for (const PathRay& ray : generation(depth + 1).rays)
        rays[ray.parent].colour += ray.share * (ray.passed * ray.colour);
}

// Follows the rays at work to where they end, through surfaces that are hidden inside of glass of a
// higher priority, and sends on the next generation.
void BatchTracer::find_points(const Job& job, int depth) {
    points_.clear();
    for (int hidden = 0; !at_work_.empty(); ++hidden) {
        if (job.stop.stop_requested()) return;
        intersect_groups(job);
        if (depth == 1 && hidden == 0) {
            for (std::size_t i = 0; i < hits_.size(); ++i) {
                if (!hits_[i].valid()) continue;
                ++job.counts.eye_hits;
                job.results[at_work_[i]].hit = hits_[i];
            }
        }
        std::size_t left = 0;
        for (std::size_t i = 0; i < at_work_.size(); ++i) {
            if (!arrive(job, depth, hidden, i)) continue;
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
void BatchTracer::intersect_groups(const Job& job) {
    hits_.resize(rays_.size());
    for (std::size_t first = 0; first < rays_.size();) {
        std::size_t end = first + 1;
        while (end < rays_.size() && directions_[end] == directions_[first])
            ++end;
        job.scene.accel->intersect(std::span(rays_).subspan(first, end - first),
                                   std::span(hits_).subspan(first, end - first));
        first = end;
    }
}

// What ray i of those at work brings back by itself. True: it goes on, since the surface is hidden.
bool BatchTracer::arrive(const Job& job, int depth, int hidden, std::size_t i) {
    Generation& at = generation(depth);
    PathRay& path = at.rays[at_work_[i]];
    const ShadeScene& scene = job.scene;
    const Hit& hit = hits_[i];
    const Interior* interior = at.interior_of(path);
    if (!hit.valid()) {
        const MaterialId medium =
            interior != nullptr ? interior->medium(*scene.scene) : kNoMaterial;
        path.colour = passed(scene, medium, rays_[i].t_max) *
                      environment_colour(*scene.scene, rays_[i].direction, path.cone.spread);
        return false;
    }
    const FoundHit found = find_surface(scene, rays_[i], hit);
    const Boundary boundary = boundary_at(scene, found, hit, interior);
    path.passed *= passed(scene, boundary.medium, hit.t);
    path.cone.width = path.cone.at(hit.t);
    if (!boundary.is_there && hidden < kMostHidden) {
        at.put_inside(path, boundary.crossing->after);
        rays_[i] = Ray{offset_origin(found.surface, rays_[i].direction), rays_[i].direction};
        return true;
    }
    if (boundary.crossing) at.put_inside(path, boundary.crossing->before);
    path.weight *= largest(path.passed);
    points_.push_back(
        {at_work_[i], shading_point(scene, found, rays_[i].direction, path.cone.width)});
    const LitPoint& lit = points_.back();
    if (depth == 1) job.results[path.parent].normal = lit.point.normal;
    path.colour = own_light(scene, lit.point);
    if (depth < scene.settings.depth) send_branches(job, depth, lit, boundary);
    return false;
}

// Rays of the next generation.
void BatchTracer::send_branches(const Job& job, int depth, const LitPoint& from,
                                const Boundary& boundary) {
    const Generation& at = generation(depth);
    Generation& next = generation(depth + 1);
    const PathRay& path = at.rays[from.ray];
    const Branches branches = branches_at(job.scene, from.point, boundary, path.weight);
    for (std::size_t i = 0; i < branches.count; ++i) {
        const Branch& branch = branches.branch[i];
        count_branch(job.counts, branch.kind, depth + 1);
        PathRay onwards;
        onwards.ray = leaving(from.point, branch.direction);
        onwards.share = branch.share;
        onwards.parent = from.ray;
        onwards.cone = path.cone;
        onwards.weight = branch.weight;
        onwards.seed = branch_seed(job.scene, path.seed, branch.kind);
        onwards.direction = direction_group(branch.kind, branch.direction);
        if (branch.kind == BranchKind::transmitted && boundary.crossing) {
            next.put_inside(onwards, boundary.crossing->after);
        } else if (path.interior != kNoInterior) {
            next.put_inside(onwards, at.interiors[path.interior]);
        }
        next.rays.push_back(onwards);
    }
}

// One light after the other, so that rays to the same light travel together.
void BatchTracer::light_points(const Job& job, int depth) {
    std::vector<PathRay>& rays = generation(depth).rays;
    for (std::size_t light = 0; light < job.scene.lights.size(); ++light) {
        for (int sample = 0; sample < job.scene.lights[light].count(); ++sample) {
            if (job.stop.stop_requested()) return;
            light_points_by(job, depth, light, sample);
        }
    }
    for (const LitPoint& lit : points_)
        rays[lit.ray].colour = lit.point.material.opacity * rays[lit.ray].colour;
}

void BatchTracer::light_points_by(const Job& job, int depth, std::size_t light, int sample) {
    const bool shadows = job.scene.settings.shadows;
    std::vector<PathRay>& rays = generation(depth).rays;
    const PreparedLight& source = job.scene.lights[light];
    arriving_.clear();
    shadow_rays_.clear();
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        const ShadingPoint& point = points_[i].point;
        const std::uint64_t seed = light_seed(job.scene, rays[points_[i].ray].seed, light);
        const LightSample arriving = light_sample(source, point.surface.position, sample, seed);
        if (!faces(point, arriving) || (shadows && shades_itself(point, arriving))) continue;
        arriving_.push_back({i, arriving});
        if (shadows) shadow_rays_.push_back(shadow_ray(point, arriving));
    }
    shares_.assign(arriving_.size(), glm::vec3(1.0f));
    if (shadows) find_shares(job, depth, source);
    for (std::size_t i = 0; i < arriving_.size(); ++i) {
        if (shares_[i] == glm::vec3(0.0f)) continue;
        const LitPoint& lit = points_[arriving_[i].point];
        rays[lit.ray].colour += lit_by(lit.point, arriving_[i].light, shares_[i]);
    }
}

// What arrives of the light along the shadow rays.
void BatchTracer::find_shares(const Job& job, int depth, const PreparedLight&) {
    count_shadows(job.counts, shadow_rays_.size(), depth);
    if (job.scene.settings.glass_shadows == GlassShadows::tinted) {
        const Generation& at = generation(depth);
        for (std::size_t i = 0; i < shadow_rays_.size(); ++i) {
            if (job.stop.stop_requested()) return;
            const PathRay& path = at.rays[points_[arriving_[i].point].ray];
            shares_[i] =
                transmittance(job.scene, shadow_rays_[i], at.interior_of(path), path.cone.width);
        }
    } else {
        blocked_.resize(shadow_rays_.size());
        job.scene.accel->occluded(shadow_rays_, blocked_);
        for (std::size_t i = 0; i < blocked_.size(); ++i)
            if (blocked_[i] != 0) shares_[i] = glm::vec3(0.0f);
    }
    for (const glm::vec3& share : shares_)
        job.counts.shadow_blocked += share == glm::vec3(0.0f) ? 1 : 0;
}

}  // namespace raypick
