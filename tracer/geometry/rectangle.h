// Part of a ray's intersection with a rectangle.
#pragma once

#include "tracer/geometry/shapes.h"

namespace raypick {

// Sets the hit of a ray that is known to pass within the rectangle to that of intersect(). In place:
// copies of what was just put together make processors wait for the parts. False: there is none.
bool meet_within(const Rectangle& rectangle, const ObjectRay& ray, ShapeHit& hit);

}  // namespace raypick
