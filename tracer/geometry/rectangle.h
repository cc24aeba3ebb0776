// Parts of a ray's intersection with a rectangle, for those who don't need all of it.
#pragma once

#include "tracer/geometry/shapes.h"

#include <optional>

namespace raypick {

// Not normalised.
glm::dvec3 rectangle_normal(const Rectangle& rectangle);

// Where the ray meets the rectangle's plane; nothing if it runs along it, or on a NaN.
std::optional<double> meet_plane_of(const Rectangle& rectangle, const ObjectRay& ray);

bool passes_within(const Rectangle& rectangle, const ObjectRay& ray);

// Sets the hit of a ray that is known to pass within the rectangle to that of intersect(). In
// place: copies of what was just put together make processors wait for the parts. False: there is
// none.
bool meet_within(const Rectangle& rectangle, const ObjectRay& ray, ShapeHit& hit);

}  // namespace raypick
