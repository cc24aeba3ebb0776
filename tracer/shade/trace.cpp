#include "tracer/shade/trace.h"

#include "tracer/shade/branches.h"
#include "tracer/shade/lit_point.h"
#include "tracer/shade/shadow.h"

namespace raypick {

namespace {

// How a ray got where it is.
struct Path {
    Interior interior;  // what it goes through
    RayCone cone;
    float weight = 1.0f;     // the most that it can add to its pixel
    int depth = 1;           // an eye ray has 1
    std::uint64_t seed = 0;  // of what is random at its end
};

// trace(R) of the notes, with the scene and the settings at hand.
class Tracer {
public:
    Tracer(const ShadeScene& scene, RayCounts& counts, const std::stop_token& stop)
        : scene_(scene), counts_(counts), stop_(stop) {}

    TracedRay eye_ray(const EyeRay& eye) {
        ++counts_.eye;
        TracedRay result;
        Path path;
        path.cone = eye.cone;
        path.seed = eye.seed;
        const auto hit = scene_.accel->intersect(eye.ray);
        if (!hit) {
            result.colour = beyond(eye.ray, path);
            return result;
        }
        ++counts_.eye_hits;
        result.hit = *hit;
        result.colour = at_hit(eye.ray, *hit, path, &result.normal);
        return result;
    }

private:
    // What comes along a ray, at its origin.
    glm::vec3 follow(const Ray& ray, const Path& path) {
        if (stop_.stop_requested()) return glm::vec3(0.0f);
        const auto hit = scene_.accel->intersect(ray);
        return hit ? at_hit(ray, *hit, path, nullptr) : beyond(ray, path);
    }

    // What comes along a ray that hits nothing.
    [[nodiscard]] glm::vec3 beyond(const Ray& ray, const Path& path) const {
        return passed(scene_, path.interior.medium(*scene_.scene), ray.t_max) *
               sky_colour(scene_, ray.direction, path.cone.spread);
    }

    // Goes on through surfaces that are hidden inside of glass of a higher priority.
    glm::vec3 at_hit(Ray ray, Hit hit, Path path, glm::vec3* normal) {
        glm::vec3 share(1.0f);
        for (int hidden = 0;; ++hidden) {
            const FoundHit found = find_surface(scene_, ray, hit);
            Crossing room;
            const Boundary boundary = boundary_at(scene_, found, hit, &path.interior, room);
            share *= passed(scene_, boundary.medium, hit.t);
            path.cone.width = path.cone.at(hit.t);
            if (boundary.is_there || hidden == kMostHidden) {
                if (boundary.crossing != nullptr) path.interior = boundary.crossing->before;
                path.weight *= largest(share);
                SurfaceMaterial with_maps;
                const ShadingPoint point =
                    shading_point(scene_, found, ray.direction, path.cone.width, &with_maps);
                if (normal != nullptr) *normal = point.normal;
                return share * shade(point, boundary, path);
            }
            path.interior = boundary.crossing->after;
            ray = Ray{offset_origin(found.surface, ray.direction), ray.direction};
            const auto next = scene_.accel->intersect(ray);
            if (!next) return share * beyond(ray, path);
            hit = *next;
        }
    }

    // Steps (a) to (d): the lights, transmission, reflection, and their sum.
    glm::vec3 shade(const ShadingPoint& point, const Boundary& boundary, const Path& path) {
        glm::vec3 colour = point.material.opacity * local(point, path);
        if (path.depth >= scene_.settings.depth) return colour;
        Branches branches;
        find_branches(scene_, point, boundary, path.weight, branches);
        for (std::size_t i = 0; i < branches.count; ++i) {
            const Branch& branch = branches.branch[i];
            const Path next = onwards(path, branch, boundary);
            count_branches(counts_, branch.kind, 1, next.depth);
            colour += branch.share * follow(leaving(point, branch.direction), next);
        }
        return colour;
    }

    [[nodiscard]] Path onwards(const Path& path, const Branch& branch,
                               const Boundary& boundary) const {
        Path next = path;
        if (branch.kind == BranchKind::transmitted && boundary.crossing != nullptr) {
            next.interior = boundary.crossing->after;
        }
        next.weight = branch.weight;
        ++next.depth;
        next.seed = branch_seed(scene_, path.seed, branch.kind);
        return next;
    }

    glm::vec3 local(const ShadingPoint& point, const Path& path) {
        LitPoint lit;
        set_lit_point(point, lit);
        glm::vec3 colour = own_light(*scene_.scene, point.material);
        for (std::size_t l = 0; l < scene_.lights.size(); ++l) {
            const PreparedLight& light = scene_.lights[l];
            const std::uint64_t seed = light_seed(scene_, path.seed, l);
            for (int i = 0; i < light.count(); ++i) {
                const LightSample sample = light_sample(light, lit.position, i, seed);
                if (!faces(lit, sample)) continue;
                const glm::vec3 share = unshadowed(lit, path, sample);
                if (share != glm::vec3(0.0f)) colour += lit_by(lit, sample, share);
            }
        }
        return colour;
    }

    // The share of the light that arrives.
    glm::vec3 unshadowed(const LitPoint& point, const Path& path, const LightSample& light) {
        if (!scene_.settings.shadows) return glm::vec3(1.0f);
        if (shades_itself(point, light)) return glm::vec3(0.0f);
        count_shadows(counts_, 1, path.depth);
        Ray ray;
        set_shadow_ray(point, light, ray);
        glm::vec3 share(0.0f);
        if (scene_.settings.glass_shadows == GlassShadows::tinted) {
            share = transmittance(scene_, ray, &path.interior, path.cone.width);
        } else if (!scene_.accel->occluded(ray)) {
            share = glm::vec3(1.0f);
        }
        if (share == glm::vec3(0.0f)) ++counts_.shadow_blocked;
        return share;
    }

    const ShadeScene& scene_;
    RayCounts& counts_;
    const std::stop_token& stop_;
};

}  // namespace

TracedRay trace(const ShadeScene& scene, const EyeRay& eye, RayCounts& counts,
                const std::stop_token& stop) {
    return Tracer(scene, counts, stop).eye_ray(eye);
}

TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const EyeRay& eye, RayCounts& counts, const std::stop_token& stop) {
    return trace(shade_scene(accel, lights, settings), eye, counts, stop);
}

TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const Ray& ray, RayCounts& counts, const std::stop_token& stop) {
    return trace(accel, lights, settings, EyeRay{ray, {}}, counts, stop);
}

}  // namespace raypick
