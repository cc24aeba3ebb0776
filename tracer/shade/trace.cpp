#include "tracer/shade/trace.h"

#include "tracer/shade/fresnel.h"
#include "tracer/shade/interior.h"
#include "tracer/shade/light_sample.h"
#include "tracer/shade/local_light.h"
#include "tracer/shade/random.h"
#include "tracer/shade/textured.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

namespace raypick {

namespace {

// A hit as the shading sees it: normals turned to the side the ray came from.
struct ShadingPoint {
    const SurfacePoint& surface;
    const Material& kind;      // before its maps
    SurfaceMaterial material;  // after them
    glm::vec3 normal;          // shading normal
    glm::vec3 geometric;       // geometric normal
    glm::vec3 incoming;        // unit direction of the ray that arrived here
};

ShadingPoint shading_point(const Scene& scene, const SurfacePoint& surface, const Ray& ray,
                           float width) {
    const Material& kind = material(scene, surface.material);
    const float side = surface.front_face ? 1.0f : -1.0f;
    return {surface,
            kind,
            textured(scene, kind, surface, ray.direction, width),
            side * mapped_normal(scene, kind, surface, ray.direction, width),
            side * surface.geometric_normal,
            ray.direction};
}

// Mirror direction about the shading normal; about the geometric one where the former would lead
// into the surface.
glm::vec3 reflect_direction(const ShadingPoint& point) {
    const auto about = [&](const glm::vec3& n) {
        return glm::normalize(point.incoming - 2.0f * glm::dot(point.incoming, n) * n);
    };
    const glm::vec3 mirrored = about(point.normal);
    return glm::dot(mirrored, point.geometric) > 0.0f ? mirrored : about(point.geometric);
}

// Snell's law at a normal on the ray's side; nothing on total internal reflection. `eta` is the
// index before over the index beyond.
std::optional<glm::vec3> refract(const glm::vec3& incoming, const glm::vec3& normal, float eta) {
    const float cosine = -glm::dot(incoming, normal);
    const float squared = 1.0f - eta * eta * (1.0f - cosine * cosine);
    if (!(squared >= 0.0f)) return std::nullopt;
    return glm::normalize(eta * incoming + (eta * cosine - std::sqrt(squared)) * normal);
}

// About the shading normal; about the geometric one where the former faces away or leads the ray
// back.
std::optional<glm::vec3> refract_direction(const ShadingPoint& point, float eta) {
    if (eta == 1.0f) return point.incoming;
    if (glm::dot(point.incoming, point.normal) < 0.0f) {
        const auto refracted = refract(point.incoming, point.normal, eta);
        if (!refracted || glm::dot(*refracted, point.geometric) < 0.0f) return refracted;
    }
    return refract(point.incoming, point.geometric, eta);
}

float largest(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

// What is left after this way through a medium (Beer and Lambert's law).
glm::vec3 passed(const Scene& scene, MaterialId medium, float distance) {
    const glm::vec3 absorption = material(scene, medium).absorption;
    glm::vec3 share(1.0f);
    for (int i = 0; i < 3; ++i) {
        if (absorption[i] > 0.0f) share[i] = std::exp(-absorption[i] * distance);
    }
    return share;
}

float index_of(const Scene& scene, MaterialId medium) {
    return medium == kNoMaterial ? 1.0f : material(scene, medium).ior;
}

// How a ray got where it is.
struct Path {
    Interior interior;  // what it goes through
    RayCone cone;
    float weight = 1.0f;     // the most that it can add to its pixel
    int depth = 1;           // an eye ray has 1
    std::uint64_t seed = 0;  // of what is random at its end
};

// What a ray's seed is derived by from that of the ray before: randomness depends on the way to a
// point, not on which rays were followed before it.
enum Branch : std::uint64_t { kTransmitted, kMirrored, kStraight, kLights };

// A surface with the glass on both sides of it, as one ray meets it.
struct Boundary {
    Crossing crossing;  // before == after where the surface bounds no body
    float eta = 1.0f;   // index before over index beyond
    bool bounds_body = false;
    bool is_there = true;
};

// What leaves a surface: shares of a mirrored and of a transmitted ray.
struct Split {
    glm::vec3 mirrored{0.0f};
    glm::vec3 transmitted{0.0f};
    std::optional<glm::vec3> through;  // direction of the transmitted ray
};

// trace(R) of the notes, with the scene and the settings at hand.
class Tracer {
public:
    Tracer(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
           RayCounts& counts, const std::stop_token& stop)
        : accel_(accel), scene_(accel.scene()), settings_(settings), counts_(counts), stop_(stop) {
        for (const Light& light : lights)
            lights_.push_back(prepared(light));
    }

    TracedRay eye_ray(const EyeRay& eye) {
        ++counts_.eye;
        TracedRay result;
        Path path;
        path.cone = eye.cone;
        path.seed = eye.seed;
        const auto hit = accel_.intersect(eye.ray);
        if (!hit) {
            result.colour = environment_colour(scene_, eye.ray.direction, eye.cone.spread);
            return result;
        }
        ++counts_.eye_hits;
        result.hit = *hit;
        result.colour = at_hit(eye.ray, *hit, path, &result.normal);
        return result;
    }

private:
    // Surfaces inside of glass of a higher priority that a ray goes through at most.
    static constexpr int kMostHidden = 64;

    // What comes along a ray, at its origin.
    glm::vec3 follow(const Ray& ray, const Path& path) {
        if (stop_.stop_requested()) return glm::vec3(0.0f);
        const auto hit = accel_.intersect(ray);
        return hit ? at_hit(ray, *hit, path, nullptr) : beyond(ray, path);
    }

    // What comes along a ray that hits nothing.
    [[nodiscard]] glm::vec3 beyond(const Ray& ray, const Path& path) const {
        return environment_colour(scene_, ray.direction, path.cone.spread) *
               passed(scene_, path.interior.medium(scene_), ray.t_max);
    }

    // Goes on through surfaces that are hidden inside of glass of a higher priority.
    glm::vec3 at_hit(Ray ray, Hit hit, Path path, glm::vec3* normal) {
        glm::vec3 share(1.0f);
        for (int hidden = 0;; ++hidden) {
            const SurfacePoint surface = surface_point(scene_, ray, hit);
            const Boundary boundary = boundary_at(hit, surface, path.interior);
            share *= passed(scene_, boundary.crossing.from, hit.t);
            path.cone.width = path.cone.at(hit.t);
            if (boundary.is_there || hidden == kMostHidden) {
                path.interior = boundary.crossing.before;
                path.weight *= largest(share);
                const ShadingPoint point = shading_point(scene_, surface, ray, path.cone.width);
                if (normal != nullptr) *normal = point.normal;
                return share * shade(point, boundary, path);
            }
            path.interior = boundary.crossing.after;
            Ray onwards;
            onwards.origin = offset_origin(surface, ray.direction);
            onwards.direction = ray.direction;
            ray = onwards;
            const auto next = accel_.intersect(ray);
            if (!next) return share * beyond(ray, path);
            hit = *next;
        }
    }

    Boundary boundary_at(const Hit& hit, const SurfacePoint& surface, const Interior& interior) {
        const Material& kind = material(scene_, surface.material);
        Boundary boundary;
        boundary.bounds_body = settings_.refractions && fills(kind);
        if (boundary.bounds_body) {
            const Object& object = scene_.objects[object_index(scene_, hit.object)];
            boundary.crossing = cross_surface(scene_, interior, body_of(object, hit),
                                              surface.material, surface.front_face);
            boundary.is_there = is_there(scene_, boundary.crossing, surface.material);
            boundary.eta =
                index_of(scene_, boundary.crossing.from) / index_of(scene_, boundary.crossing.to);
        } else {
            const MaterialId medium = interior.medium(scene_);
            boundary.crossing = {interior, interior, medium, medium};
        }
        return boundary;
    }

    // Steps (a) to (d): reflection, transmission, the lights, and their sum.
    glm::vec3 shade(const ShadingPoint& point, const Boundary& boundary, const Path& path) {
        const float opacity = point.material.opacity;
        glm::vec3 colour = opacity * local(point, path);
        if (path.depth >= settings_.depth) return colour;
        const Split split = split_at(point, boundary);
        if (settings_.refractions && point.kind.transmits() && split.through) {
            colour += transmitted(point, *split.through, opacity * split.transmitted,
                                  boundary.crossing.after, path, kTransmitted);
        }
        const bool mirrors =
            settings_.reflections && (point.kind.reflects() || point.kind.transmits());
        if (mirrors || split.mirrored != glm::vec3(0.0f)) {
            colour += mirrored(point, opacity * split.mirrored, path);
        }
        if (opacity < 1.0f && settings_.refractions) {
            colour += transmitted(point, point.incoming, glm::vec3(1.0f - opacity), path.interior,
                                  path, kStraight);
        }
        return colour;
    }

    [[nodiscard]] Split split_at(const ShadingPoint& point, const Boundary& boundary) const {
        Split split;
        const bool refracts = settings_.refractions && point.kind.transmits();
        if (refracts) {
            split.through = refract_direction(point, boundary.eta);
            split.transmitted = point.material.transmit;
        }
        if (settings_.reflections) split.mirrored = point.material.reflect;
        const float cosine = std::clamp(-glm::dot(point.incoming, point.normal), 0.0f, 1.0f);
        if (point.kind.reflectance == Reflectance::dielectric) {
            const float f = point.kind.thin_walled ? fresnel_sheet(cosine, 1.0f / point.kind.ior)
                            : boundary.bounds_body ? fresnel_dielectric(cosine, boundary.eta)
                                                   : fresnel_outside(point, cosine);
            split.mirrored *= f;
            if (split.through) split.transmitted *= 1.0f - f;
        } else if (point.kind.reflectance == Reflectance::conductor &&
                   split.mirrored != glm::vec3(0.0f)) {
            split.mirrored = fresnel_conductor(split.mirrored, cosine);
        }
        if (refracts && !split.through) {  // total internal reflection
            const bool constant = point.kind.reflectance == Reflectance::constant;
            if (constant || !settings_.reflections) split.mirrored += split.transmitted;
        }
        return split;
    }

    // Of a dielectric that nothing enters: a coat of varnish.
    static float fresnel_outside(const ShadingPoint& point, float cosine) {
        const float ior = point.kind.ior;
        return fresnel_dielectric(cosine, point.surface.front_face ? 1.0f / ior : ior);
    }

    [[nodiscard]] bool worth_a_ray(const Path& path) const {
        return settings_.cutoff == 0.0f || path.weight > settings_.cutoff;
    }

    // A ray that leaves the point, with its share of the pixel.
    [[nodiscard]] static Path onwards(const Path& path, const glm::vec3& share,
                                      const Interior& interior, Branch branch) {
        Path next = path;
        next.interior = interior;
        next.weight *= largest(share);
        ++next.depth;
        next.seed = RandomSequence::derive(path.seed, branch);
        return next;
    }

    glm::vec3 transmitted(const ShadingPoint& point, const glm::vec3& direction,
                          const glm::vec3& share, const Interior& interior, const Path& path,
                          Branch branch) {
        const Path next = onwards(path, share, interior, branch);
        if (!worth_a_ray(next)) return glm::vec3(0.0f);
        ++counts_.refraction;
        ++counts_.refraction_at[level(next)];
        return share * follow(leaving(point, direction), next);
    }

    glm::vec3 mirrored(const ShadingPoint& point, const glm::vec3& share, const Path& path) {
        const Path next = onwards(path, share, path.interior, kMirrored);
        if (!worth_a_ray(next)) return glm::vec3(0.0f);
        ++counts_.reflection;
        ++counts_.reflection_at[level(next)];
        return share * follow(leaving(point, reflect_direction(point)), next);
    }

    static Ray leaving(const ShadingPoint& point, const glm::vec3& direction) {
        Ray ray;
        ray.origin = offset_origin(point.surface, direction);
        ray.direction = direction;
        return ray;
    }

    static std::size_t level(const Path& path) {
        return static_cast<std::size_t>(std::min(path.depth, kMaxDepth));
    }

    glm::vec3 local(const ShadingPoint& point, const Path& path) {
        glm::vec3 colour = point.material.emissive + point.material.ambient * scene_.ambient;
        for (std::size_t l = 0; l < lights_.size(); ++l) {
            const std::uint64_t seed = RandomSequence::derive(path.seed, kLights + l);
            for (int i = 0; i < lights_[l].count(); ++i) {
                colour +=
                    lit_by(point, path, light_sample(lights_[l], point.surface.position, i, seed));
            }
        }
        return colour;
    }

    glm::vec3 lit_by(const ShadingPoint& point, const Path& path, const LightSample& arriving) {
        if (arriving.colour == glm::vec3(0.0f)) return glm::vec3(0.0f);
        if (!(glm::dot(point.normal, arriving.direction) > 0.0f)) return glm::vec3(0.0f);
        glm::vec3 share(1.0f);
        if (settings_.shadows) share = unshadowed(point, path, arriving);
        if (share == glm::vec3(0.0f)) return share;
        return share * arriving.colour *
               local_light(point.material, point.normal, arriving.direction, -point.incoming);
    }

    // The share of the light that arrives.
    glm::vec3 unshadowed(const ShadingPoint& point, const Path& path, const LightSample& light) {
        // Behind the flat face although in front of the smooth normal: the surface shades itself.
        if (!(glm::dot(point.geometric, light.direction) > 0.0f)) return glm::vec3(0.0f);
        ++counts_.shadow;
        ++counts_.shadow_at[level(path)];
        Ray ray = leaving(point, light.direction);
        // Not a surface that lies in the light itself.
        ray.t_max = light.distance * static_cast<float>(1.0 - 2.0 * kTieGap);
        glm::vec3 share(0.0f);
        if (settings_.glass_shadows == GlassShadows::tinted) {
            share = transmittance(ray, path.interior, path.cone.width);
        } else {
            share = glm::vec3(accel_.occluded(ray) ? 0.0f : 1.0f);
        }
        if (share == glm::vec3(0.0f)) ++counts_.shadow_blocked;
        return share;
    }

    // Straight through all glass; 0 if anything else is in the way.
    [[nodiscard]] glm::vec3 transmittance(const Ray& ray, const Interior& interior,
                                          float width) const {
        std::vector<Hit> crossed;
        const auto opaque = [&](const Hit& hit) {
            const Object& object = scene_.objects[object_index(scene_, hit.object)];
            const Material& kind = material(scene_, material_id(scene_, object, hit.primitive));
            const bool see_through =
                kind.transmits() || (kind.alpha_mode == AlphaMode::blend &&
                                     (kind.opacity < 1.0f || kind.map(MapSlot::opacity)));
            if (see_through) crossed.push_back(hit);
            return !see_through;
        };
        RayQuery query;
        query.accept = opaque;
        if (accel_.occluded(ray, query)) return glm::vec3(0.0f);
        std::sort(crossed.begin(), crossed.end(), [](const Hit& a, const Hit& b) {
            return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
        });
        return through_all(ray, crossed, interior, width);
    }

    [[nodiscard]] glm::vec3 through_all(const Ray& ray, const std::vector<Hit>& crossed,
                                        Interior interior, float width) const {
        glm::vec3 share(1.0f);
        float reached = 0.0f;
        for (const Hit& hit : crossed) {
            const SurfacePoint surface = surface_point(scene_, ray, hit);
            const Material& kind = material(scene_, surface.material);
            const Object& object = scene_.objects[object_index(scene_, hit.object)];
            bool there = true;
            MaterialId medium = interior.medium(scene_);
            if (fills(kind)) {
                const Crossing crossing = cross_surface(scene_, interior, body_of(object, hit),
                                                        surface.material, surface.front_face);
                medium = crossing.from;
                interior = crossing.after;
                there = is_there(scene_, crossing, surface.material);
            }
            share *= passed(scene_, medium, hit.t - reached);
            reached = hit.t;
            if (!there) continue;
            const SurfaceMaterial look = textured(scene_, kind, surface, ray.direction, width);
            share *= glm::vec3(1.0f - look.opacity) + look.opacity * look.transmit;
        }
        if (std::isfinite(ray.t_max)) {
            share *= passed(scene_, interior.medium(scene_), ray.t_max - reached);
        }
        return share;
    }

    const Accel& accel_;
    const Scene& scene_;
    std::vector<PreparedLight> lights_;
    const RenderSettings& settings_;
    RayCounts& counts_;
    const std::stop_token& stop_;
};

}  // namespace

RayCounts& RayCounts::operator+=(const RayCounts& other) {
    eye += other.eye;
    eye_hits += other.eye_hits;
    reflection += other.reflection;
    refraction += other.refraction;
    shadow += other.shadow;
    shadow_blocked += other.shadow_blocked;
    for (std::size_t i = 0; i < reflection_at.size(); ++i) {
        reflection_at[i] += other.reflection_at[i];
        refraction_at[i] += other.refraction_at[i];
        shadow_at[i] += other.shadow_at[i];
    }
    return *this;
}

TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const EyeRay& eye, RayCounts& counts, const std::stop_token& stop) {
    return Tracer(accel, lights, settings, counts, stop).eye_ray(eye);
}

TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const Ray& ray, RayCounts& counts, const std::stop_token& stop) {
    return trace(accel, lights, settings, EyeRay{ray, {}}, counts, stop);
}

}  // namespace raypick
