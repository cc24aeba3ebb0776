// What comes through glass to a lit point.
#pragma once

#include "tracer/shade/boundary.h"

#include <glm/vec3.hpp>

#include <span>

namespace raypick {

// The share of light that comes straight through all glass on a shadow ray's way; 0 if anything
// else is in the way. `interior`: the bodies around the ray's origin, nullptr: none; `width`: of
// the cone of the ray that arrived there.
glm::vec3 transmittance(const ShadeScene& scene, const Ray& ray, const Interior* interior,
                        float width);
// The same of a ray of which all is known that it crosses, in the order of sort_along_ray.
glm::vec3 transmittance_through(const ShadeScene& scene, const Ray& ray,
                                std::span<const Hit> crossed, const Interior* interior,
                                float width);

}  // namespace raypick
