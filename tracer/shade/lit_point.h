// What lights need to know of a point, and what they add there.
#pragma once

#include "tracer/shade/boundary.h"
#include "tracer/shade/light_sample.h"
#include "tracer/shade/local_light.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace raypick {

struct LitPoint {
    glm::vec3 position{0.0f};
    glm::vec3 outside{0.0f};  // origin of rays to the lights
    glm::vec3 normal{0.0f};   // shading and geometric one, on the side that the ray sees
    glm::vec3 geometric{0.0f};
    glm::vec3 to_eye{0.0f};  // where the ray came from, unit
    const SurfaceMaterial* material = nullptr;
};

inline void set_lit_point(const ShadingPoint& point, LitPoint& lit) {
    lit.position = point.surface.position;
    lit.outside = offset_origin(point.surface, point.geometric);
    lit.normal = point.normal;
    lit.geometric = point.geometric;
    lit.to_eye = -point.incoming;
    lit.material = &point.material;
}

// Whether the light falls on the side that the ray sees, by the shading normal.
inline bool faces(const LitPoint& point, const LightSample& light) {
    return glm::dot(point.normal, light.direction) > 0.0f && light.colour != glm::vec3(0.0f);
}

// Behind the flat face although in front of the smooth normal.
inline bool shades_itself(const LitPoint& point, const LightSample& light) {
    return !(glm::dot(point.geometric, light.direction) > 0.0f);
}

// How far a shadow ray looks: not to a surface that lies in the light itself.
inline float shadow_reach(float distance) {
    return distance * static_cast<float>(1.0 - 2.0 * kTieGap);
}

// From the point to the light, which the surface does not keep off itself.
inline void set_shadow_ray(const LitPoint& point, const LightSample& light, Ray& ray) {
    ray.origin = point.outside;
    ray.direction = light.direction;
    ray.t_min = 0.0f;
    ray.t_max = shadow_reach(light.distance);
}

// What this share of the light adds to the point's colour.
inline glm::vec3 lit_by(const LitPoint& point, const LightSample& light, const glm::vec3& share) {
    return share * light.colour *
           local_light(*point.material, point.normal, light.direction, point.to_eye);
}

}  // namespace raypick
