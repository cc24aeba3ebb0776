// What of a light arrives at a lit point.
#pragma once

#include "tracer/shade/boundary.h"
#include "tracer/shade/light_sample.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace raypick {

// Whether the light falls on the side that the ray sees, by the shading normal.
inline bool faces(const ShadingPoint& point, const LightSample& light) {
    return glm::dot(point.normal, light.direction) > 0.0f && light.colour != glm::vec3(0.0f);
}

// Behind the flat face although in front of the smooth normal.
inline bool shades_itself(const ShadingPoint& point, const LightSample& light) {
    return !(glm::dot(point.geometric, light.direction) > 0.0f);
}

// From the point to the light, but not to a surface that lies in the light itself.
inline Ray shadow_ray(const ShadingPoint& point, const LightSample& light) {
    Ray ray = leaving(point, light.direction);
    ray.t_max = light.distance * static_cast<float>(1.0 - 2.0 * kTieGap);
    return ray;
}

// What this share of the light adds to the point's colour.
glm::vec3 lit_by(const ShadingPoint& point, const LightSample& light, const glm::vec3& share);

// The share of light that comes straight through all glass on a shadow ray's way; 0 if anything
// else is in the way. `interior`: the bodies around the ray's origin, nullptr: none; `width`: of
// the cone of the ray that arrived there.
glm::vec3 transmittance(const ShadeScene& scene, const Ray& ray, const Interior* interior,
                        float width);

}  // namespace raypick
