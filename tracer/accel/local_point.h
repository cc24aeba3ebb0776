// A hit in its object's own space.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/shapes.h"
#include "tracer/scene/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace raypick {

// Normals are outward and not normalised. dpdu and dpdv are the position's derivatives by
// texture_uv, 0 where these are degenerate.
struct LocalPoint {
    glm::dvec3 position{0.0};  // on the surface to double rounding of `magnitude`
    glm::dvec3 geometric_normal{0.0};
    glm::dvec3 shading_normal{0.0};
    bool smooth = false;  // false: the shading normal is the geometric one
    glm::dvec3 dpdu{0.0};
    glm::dvec3 dpdv{0.0};
    double magnitude = 0.0;  // the largest coordinate that the position was worked out from
};

// What a LocalPoint is worked out for.
struct PointNeeds {
    const glm::dmat3* world_from_object = nullptr;  // nullptr: the identity
    // Where walls meet, a point on one that rounding put beyond the other would see what lies
    // outside: so points keep off the rims of flat pieces by this much (scene space), or a quarter
    // of the piece where it is small.
    double rim = 0.0;
    bool derivatives = true;  // false: dpdu and dpdv may be left 0
};

// `ray` is the hit's ray in the object's space.
LocalPoint local_point(const Scene& scene, const Object& object, const ObjectRay& ray,
                       const Hit& hit, const PointNeeds& needs);

// The derivatives by a mesh's uv on the triangle of these corners; 0 where these are degenerate.
struct MeshDerivatives {
    glm::dvec3 dpdu{0.0};
    glm::dvec3 dpdv{0.0};
};
MeshDerivatives mesh_derivatives(const Mesh& mesh, const glm::uvec3& corner);

}  // namespace raypick
