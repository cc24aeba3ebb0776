#include "tracer/shade/batch_tracer.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

namespace raypick {

namespace {

// Rays of a generation that are there at the same time; their children are up to three times as
// many. Enough for groups that share a direction, and little enough to stay in a core's cache.
constexpr std::size_t kPortion = 1024;

}  // namespace

Generation& BatchTracer::generation(int depth) {
    const auto index = static_cast<std::size_t>(depth - 1);
    while (generations_.size() <= index)
        generations_.emplace_back();
    return generations_[index];
}

void BatchTracer::trace(const ShadeScene& scene, const EyeRays& eyes, TracedRays& results,
                        RayCounts& counts, const std::stop_token& stop) {
    const Job job{scene, eyes, results, counts, stop};
    begin(eyes);
    counts.eye += eyes.size();
    follow(job, 1);
    const LargeArray<RayPath>& paths = generation(1).paths;
    for (std::size_t i = 0; i < paths.size(); ++i)
        results.colours[i] = paths[i].passed * paths[i].colour;
}

void BatchTracer::begin(const EyeRays& eyes) {
    Generation& first = generation(1);
    first.clear();
    first.paths.resize(eyes.size());
    RayPath path;
    path.cone = eyes.cone;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        path.parent = static_cast<std::uint32_t>(i);
        path.seed = eyes.seed(i);
        first.paths[i] = path;
    }
}

void BatchTracer::set_begun(RayPath& path, std::uint32_t parent, const RayCone& cone, float weight,
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
    if (depth == 1) {
        step.at.keep_order();
    } else {
        step.at.order_by_direction();
    }
    const std::span<const std::uint32_t> order = step.at.order;
    for (std::size_t first = 0; first < order.size(); first += kPortion) {
        if (job.stop.stop_requested()) return;
        const std::size_t count = std::min(kPortion, order.size() - first);
        follow_portion(step, order.subspan(first, count));
    }
}

void BatchTracer::follow_portion(const Step& step, std::span<const std::uint32_t> portion) {
    load_rays(step, portion);
    step.next.clear();
    find_points(step);
    send_mirrored(step);
    light_points(step);
    if (step.next.paths.empty()) return;
    follow(step.job, step.depth + 1);
    // In the order in which they left.
    for (const RayPath& path : step.next.paths)
        step.at.paths[path.parent].colour += path.share * (path.passed * path.colour);
}

void BatchTracer::load_rays(const Step& step, std::span<const std::uint32_t> portion) {
    at_work_.assign(portion.begin(), portion.end());
    directions_.assign(portion.size(), 0);
    if (step.depth == 1) {  // as they come
        rays_ = step.job.eyes.rays.subspan(portion.front(), portion.size());
        return;
    }
    loaded_.resize(portion.size());
    for (std::size_t i = 0; i < portion.size(); ++i) {
        loaded_[i] = step.at.rays[portion[i]];
        directions_[i] = step.at.directions[portion[i]];
    }
    rays_ = loaded_;
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
        hidden_.clear();
        arrivals_.begin(step.job.scene, rays_, hits_);
        for (std::size_t i = 0; i < at_work_.size();) {
            if (const Arrivals::Block* full = arrivals_.add(i)) {
                arrive(step, hidden, *full);
            } else {
                i = see_sky(step, i);
            }
        }
        while (const Arrivals::Block* rest = arrivals_.rest())
            arrive(step, hidden, *rest);
        keep_hidden();
    }
}

// Of the rays at work those that go on.
void BatchTracer::keep_hidden() {
    std::sort(hidden_.begin(), hidden_.end(),  // those that travel together side by side again
              [](const HiddenAt& a, const HiddenAt& b) { return a.i < b.i; });
    loaded_.resize(hidden_.size());
    for (std::size_t k = 0; k < hidden_.size(); ++k) {
        at_work_[k] = at_work_[hidden_[k].i];
        directions_[k] = directions_[hidden_[k].i];
        loaded_[k] = hidden_[k].onwards;
    }
    at_work_.resize(hidden_.size());
    directions_.resize(hidden_.size());
    rays_ = loaded_;
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
        scene.accel->intersect(rays_.subspan(first, end - first),
                               std::span(hits_).subspan(first, end - first), query);
        first = end;
    }
}

void BatchTracer::note_first_hits(const Job& job) {
    for (std::size_t i = 0; i < hits_.size(); ++i) {
        job.counts.eye_hits += hits_[i].valid() ? 1 : 0;
        if (!job.results.has_hits()) continue;
        job.results.hits[at_work_[i]] = hits_[i];
        job.results.normals[at_work_[i]] = glm::vec3(0.0f);
    }
}

// What the rays of a block bring back by themselves.
void BatchTracer::arrive(const Step& step, int hidden, const Arrivals::Block& block) {
    const std::size_t first = points_.add(block.rows);
    const auto path_of = [&](std::size_t lane) -> RayPath& {
        return step.at.paths[at_work_[block.hit[lane]]];
    };
    bool alike = true;  // all at work on the same part, with nothing that wants a closer look
    std::uint32_t others = 0;
    for (std::size_t lane = 0; lane < block.rows.count; ++lane) {
        points_.set_ray(first + lane, at_work_[block.hit[lane]]);
        const bool simple =
            arrivals_.part(block, lane).simple && path_of(lane).interior == kNoInterior;
        if (!simple) others |= 1u << lane;
        alike = alike && simple && block.part[lane] == block.part[0];
    }
    if (alike) {
        const PreparedMaterial& material = *arrivals_.part(block, 0).prepared;
        points_.set_materials(first, material.plain, material.own);
    }
    for (std::size_t lane = 0; lane < block.rows.count; ++lane) {
        if ((others >> lane & 1u) != 0) {
            arrivals_.set_found(block, lane, found_[lane]);
            continue;
        }
        const PreparedMaterial& material = *arrivals_.part(block, lane).prepared;
        if (!alike) points_.set_material(first + lane, material.plain, material.own);
        arrive_simply(step, path_of(lane), material, block.hit[lane], first + lane);
    }
    for (; others != 0; others &= others - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(others));
        arrive(step, hidden, found_[lane], block.hit[lane], first + lane);
    }
}

// Ray i of those at work, at the end of a path outside of everything, on a KnownPart that is
// simple.
void BatchTracer::arrive_simply(const Step& step, RayPath& path, const PreparedMaterial& material,
                                std::size_t i, std::size_t point) {
    path.cone.width = path.cone.at(hits_[i].t);
    if (step.notes_normals()) step.job.results.normals[path.parent] = points_.normal(point);
    if (material.branches && step.depth < step.job.scene.settings.depth) {
        want_mirrored(step, point, material);
    }
}

void BatchTracer::arrive(const Step& step, int hidden, const FoundHit& found, std::size_t i,
                         std::size_t point) {
    RayPath& path = step.at.paths[at_work_[i]];
    const ShadeScene& scene = step.job.scene;
    const Hit& hit = hits_[i];
    const Ray& ray = rays_[i];
    const Boundary boundary = boundary_at(scene, found, hit, step.at.interior_of(path), crossing_);
    if (boundary.medium != kNoMaterial) path.passed *= passed(scene, boundary.medium, hit.t);
    path.cone.width = path.cone.at(hit.t);
    if (!boundary.is_there && hidden < kMostHidden) {
        step.at.put_inside(path, boundary.crossing->after);
        hidden_.push_back({static_cast<std::uint32_t>(i),
                           {offset_origin(found.surface, ray.direction), ray.direction}});
        points_.leave_out(point);
        return;
    }
    if (boundary.crossing != nullptr) step.at.put_inside(path, boundary.crossing->before);
    path.weight *= largest(path.passed);
    const PreparedMaterial& material = *found.material;
    const ShadingPoint shading =
        shading_point(scene, found, ray.direction, path.cone.width, &with_maps_);
    points_.set_material(
        point, shading.material,
        material.has_maps ? own_light(*scene.scene, shading.material) : material.own);
    if (material.has_maps) points_.set_normal(point, shading.normal);
    if (step.notes_normals()) step.job.results.normals[path.parent] = shading.normal;
    if (!material.branches || step.depth >= scene.settings.depth) return;
    if (material.only_mirrors) {
        want_mirrored(step, point, material);
    } else {
        const ShadingPoint in_memory(shading);  // lets `shading` stay in registers
        send_branches(step, at_work_[i], in_memory, boundary);
    }
}

// Of the rays at work that hit nothing, from number i on until one hits something. Returns its
// number.
std::size_t BatchTracer::see_sky(const Step& step, std::size_t i) {
    const ShadeScene& scene = step.job.scene;
    for (; i < hits_.size() && !hits_[i].valid(); ++i) {
        RayPath& path = step.at.paths[at_work_[i]];
        path.colour = sky_colour(scene, rays_[i].direction, path.cone.spread);
        if (const Interior* interior = step.at.interior_of(path)) {
            path.colour *= passed(scene, interior->medium(*scene.scene), rays_[i].t_max);
        }
    }
    return i;
}

// Rays of the next generation.
void BatchTracer::send_branches(const Step& step, std::uint32_t from, const ShadingPoint& point,
                                const Boundary& boundary) {
    const RayPath& path = step.at.paths[from];
    const ShadeScene& scene = step.job.scene;
    find_branches(scene, point, boundary, path.weight, branches_);
    for (std::size_t i = 0; i < branches_.count; ++i) {
        const Branch& branch = branches_.branch[i];
        count_branches(step.job.counts, branch.kind, 1, step.depth + 1);
        step.next.add(1);
        Ray& ray = step.next.rays.back();
        set_leaving(point, branch.direction, ray);
        ray.t_min = 0.0f;
        ray.t_max = std::numeric_limits<float>::infinity();
        step.next.directions.back() = direction_group(branch.kind, branch.direction);
        RayPath& onwards = step.next.paths.back();
        onwards.share = branch.share;
        set_begun(onwards, from, path.cone, branch.weight,
                  branch_seed(scene, path.seed, branch.kind));
        if (branch.kind == BranchKind::transmitted && boundary.crossing != nullptr) {
            step.next.put_inside(onwards, boundary.crossing->after);
        } else if (path.interior != kNoInterior) {
            step.next.put_inside(onwards, step.at.interiors[path.interior]);
        }
    }
}

// What find_branches would say of this point, on a surface that only mirrors.
void BatchTracer::want_mirrored(const Step& step, std::size_t point,
                                const PreparedMaterial& material) {
    const float weight = step.at.paths[points_.ray(point)].weight * largest(material.mirrored);
    const float cutoff = step.job.scene.settings.cutoff;
    if (cutoff != 0.0f && !(weight > cutoff)) return;
    points_.want_mirrored(point);
    mirrored_.push_back({&material, static_cast<std::uint32_t>(point), weight});
}

// More rays of the next generation.
void BatchTracer::send_mirrored(const Step& step) {
    if (mirrored_.empty()) return;
    points_.mirror();
    const std::size_t first = step.next.paths.size();
    step.next.add(mirrored_.size());
    for (std::size_t k = 0; k < mirrored_.size(); ++k) {
        const Mirrored& mirrored = mirrored_[k];
        const std::uint32_t from = points_.ray(mirrored.point);
        const RayPath& path = step.at.paths[from];
        Ray& ray = step.next.rays[first + k];
        points_.take_mirrored(mirrored.point, ray);
        step.next.directions[first + k] = direction_group(BranchKind::mirrored, ray.direction);
        RayPath& onwards = step.next.paths[first + k];
        onwards.share = mirrored.material->mirrored;
        set_begun(onwards, from, path.cone, mirrored.weight,
                  branch_seed(step.job.scene, path.seed, BranchKind::mirrored));
        if (path.interior != kNoInterior) {
            step.next.put_inside(onwards, step.at.interiors[path.interior]);
        }
    }
    count_branches(step.job.counts, BranchKind::mirrored, mirrored_.size(), step.depth + 1);
}

void BatchTracer::light_points(const Step& step) {
    light_pass_.light({step.job.scene, step.at, step.depth, step.job.counts, step.job.stop},
                      points_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (points_.holds(i)) step.at.paths[points_.ray(i)].colour = points_.colour(i);
    }
}

}  // namespace raypick
