// A hit in its object's own space.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/shapes.h"
#include "tracer/scene/scene.h"

#include <glm/vec3.hpp>

namespace raypick {

// Normals are outward and not normalised. dpdu and dpdv are the position's derivatives by
// texture_uv, 0 where these are degenerate.
struct LocalPoint {
    glm::dvec3 position{0.0};  // on the surface to double rounding of `magnitude`
    glm::dvec3 geometric_normal{0.0};
    glm::dvec3 shading_normal{0.0};
    glm::dvec3 dpdu{0.0};
    glm::dvec3 dpdv{0.0};
    double magnitude = 0.0;  // the largest coordinate that the position was worked out from
};

// `ray` is the hit's ray in the object's space. Where walls meet, a point on one that rounding put
// beyond the other would see what lies outside: so points keep off the rims of flat pieces by `rim`
// (scene space), or a quarter of the piece where it is small.
LocalPoint local_point(const Scene& scene, const Object& object, const ObjectRay& ray,
                       const Hit& hit, double rim);

}  // namespace raypick
