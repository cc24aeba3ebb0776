#include "tracer/shade/trace.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace raypick {

namespace {

// A hit as the shading sees it: normals turned to the side the ray came from.
struct ShadingPoint {
    const SurfacePoint& surface;
    const Material& material;
    glm::vec3 normal;     // shading normal
    glm::vec3 geometric;  // geometric normal
    glm::vec3 incoming;   // unit direction of the ray that arrived here
};

ShadingPoint facing(const SurfacePoint& surface, const Material& material, const Ray& ray) {
    const float side = surface.front_face ? 1.0f : -1.0f;
    return {surface, material, side * surface.shading_normal, side * surface.geometric_normal,
            ray.direction};
}

// From a point towards a light: unit direction, distance (infinite for directional lights), colour.
struct LightSample {
    glm::vec3 direction{0.0f};
    float distance = std::numeric_limits<float>::infinity();
    glm::vec3 colour{0.0f};
};

LightSample sample(const Light& light, const glm::vec3& from) {
    if (const auto* point = std::get_if<PointLight>(&light)) {
        const glm::dvec3 offset = point->position - glm::dvec3(from);
        const double distance = glm::length(offset);
        return {glm::vec3(offset / distance), static_cast<float>(distance), point->colour};
    }
    const auto& directional = std::get<DirectionalLight>(light);
    return {-glm::vec3(glm::normalize(directional.direction)),
            std::numeric_limits<float>::infinity(), directional.colour};
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

// Snell's law; nothing on total internal reflection.
std::optional<glm::vec3> refract_direction(const ShadingPoint& point) {
    const float eta = point.surface.front_face ? 1.0f / point.material.ior : point.material.ior;
    const float cosine = -glm::dot(point.incoming, point.normal);
    const float squared = 1.0f - eta * eta * (1.0f - cosine * cosine);
    if (!(squared >= 0.0f)) return std::nullopt;
    return glm::normalize(eta * point.incoming +
                          (eta * cosine - std::sqrt(squared)) * point.normal);
}

// trace(R) of the notes, with the scene and the settings at hand.
class Tracer {
public:
    Tracer(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
           RayCounts& counts, const std::stop_token& stop)
        : accel_(accel),
          scene_(accel.scene()),
          lights_(lights),
          settings_(settings),
          counts_(counts),
          stop_(stop) {}

    TracedRay eye_ray(const Ray& ray) {
        ++counts_.eye;
        TracedRay result;
        const auto hit = accel_.intersect(ray);
        if (!hit) {
            result.colour = scene_.background;
            return result;
        }
        ++counts_.eye_hits;
        const SurfacePoint surface = surface_point(scene_, ray, *hit);
        const ShadingPoint point = facing(surface, material(scene_, surface.material), ray);
        result.hit = *hit;
        result.normal = point.normal;
        result.colour = shade(point, 1);
        return result;
    }

private:
    glm::vec3 secondary_ray(const ShadingPoint& from, const glm::vec3& direction, int depth) {
        if (stop_.stop_requested()) return glm::vec3(0.0f);
        Ray ray;
        ray.origin = offset_origin(from.surface, direction);
        ray.direction = direction;
        const auto hit = accel_.intersect(ray);
        if (!hit) return scene_.background;
        const SurfacePoint surface = surface_point(scene_, ray, *hit);
        return shade(facing(surface, material(scene_, surface.material), ray), depth);
    }

    // Steps (a) to (d): reflection, transmission, the lights, and their sum.
    glm::vec3 shade(const ShadingPoint& point, int depth) {
        glm::vec3 colour = local(point);
        if (depth >= settings_.depth) return colour;
        glm::vec3 mirrored = settings_.reflections ? point.material.reflect : glm::vec3(0.0f);
        if (settings_.refractions && point.material.transmits()) {
            if (const auto direction = refract_direction(point)) {
                ++counts_.refraction;
                colour += point.material.transmit * secondary_ray(point, *direction, depth + 1);
            } else {
                mirrored += point.material.transmit;  // total internal reflection
            }
        }
        if (mirrored != glm::vec3(0.0f)) {
            ++counts_.reflection;
            colour += mirrored * secondary_ray(point, reflect_direction(point), depth + 1);
        }
        return colour;
    }

    glm::vec3 local(const ShadingPoint& point) {
        glm::vec3 colour = point.material.emissive + point.material.ambient * scene_.ambient;
        for (const Light& light : lights_) {
            const LightSample arriving = sample(light, point.surface.position);
            if (!(glm::dot(point.normal, arriving.direction) > 0.0f)) continue;
            if (settings_.shadows && shadowed(point, arriving)) continue;
            colour += arriving.colour *
                      phong(point.material, point.normal, arriving.direction, -point.incoming);
        }
        return colour;
    }

    bool shadowed(const ShadingPoint& point, const LightSample& light) {
        // Behind the flat face although in front of the smooth normal: the surface shades itself.
        if (!(glm::dot(point.geometric, light.direction) > 0.0f)) return true;
        ++counts_.shadow;
        Ray ray;
        ray.origin = offset_origin(point.surface, light.direction);
        ray.direction = light.direction;
        ray.t_max = light.distance;
        const bool blocked = accel_.occluded(ray);
        if (blocked) ++counts_.shadow_blocked;
        return blocked;
    }

    const Accel& accel_;
    const Scene& scene_;
    std::span<const Light> lights_;
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
    return *this;
}

TracedRay trace(const Accel& accel, std::span<const Light> lights, const RenderSettings& settings,
                const Ray& ray, RayCounts& counts, const std::stop_token& stop) {
    return Tracer(accel, lights, settings, counts, stop).eye_ray(ray);
}

glm::vec3 phong(const Material& material, const glm::vec3& normal, const glm::vec3& to_light,
                const glm::vec3& to_eye) {
    const float diffuse = glm::dot(normal, to_light);
    if (!(diffuse > 0.0f)) return glm::vec3(0.0f);
    const glm::vec3 mirrored = 2.0f * diffuse * normal - to_light;
    // GLSL leaves pow(0, 0) undefined, so both sides take 0 where the eye is not in the lobe.
    const float lobe = glm::dot(mirrored, to_eye);
    const float highlight = lobe > 0.0f ? std::pow(lobe, material.shininess) : 0.0f;
    return material.diffuse * diffuse + material.specular * highlight;
}

}  // namespace raypick
