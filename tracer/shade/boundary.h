// What a ray meets: a surface with the glass on both sides of it.
#pragma once

#include "tracer/shade/interior.h"
#include "tracer/shade/shade_scene.h"

#include <glm/vec3.hpp>

namespace raypick {

// Surfaces inside of glass of a higher priority that a ray goes through at most.
inline constexpr int kMostHidden = 64;

// A surface as one ray meets it.
struct Boundary {
    const Crossing* crossing = nullptr;  // only where it bounds a body
    MaterialId medium = kNoMaterial;     // that the ray came through
    float eta = 1.0f;                    // index before over index beyond
    bool is_there = true;                // false: hidden inside of glass of a higher priority
};
// `interior`: the bodies around the ray on its way there; nullptr: none. `room` is where a crossing
// goes, which is large: it must outlive the result.
Boundary boundary_of_body(const ShadeScene& scene, const FoundHit& found, const Hit& hit,
                          const Interior* interior, Crossing& room);
inline Boundary boundary_at(const ShadeScene& scene, const FoundHit& found, const Hit& hit,
                            const Interior* interior, Crossing& room) {
    if (scene.has_bodies && found.material->fills) {
        return boundary_of_body(scene, found, hit, interior, room);
    }
    Boundary boundary;
    if (interior != nullptr) boundary.medium = interior->medium(*scene.scene);
    return boundary;
}

// A hit as the shading sees it: normals turned to the side the ray came from.
struct ShadingPoint {
    const SurfacePoint& surface;
    const Material& kind;             // before its maps
    const SurfaceMaterial& material;  // after them
    glm::vec3 normal;                 // shading normal
    glm::vec3 geometric;              // geometric normal
    glm::vec3 incoming;               // unit direction of the ray that arrived here
};
// `width`: of the ray's cone there. `with_maps` is where a material with maps goes, for others it
// may be null; it and `found` must outlive the result.
inline ShadingPoint shading_point(const ShadeScene& scene, const FoundHit& found,
                                  const glm::vec3& incoming, float width,
                                  SurfaceMaterial* with_maps) {
    const SurfacePoint& surface = found.surface;
    const Material& kind = *found.material->material;
    const float side = surface.front_face ? 1.0f : -1.0f;
    const glm::vec3 geometric = side * surface.geometric_normal;
    glm::vec3 normal = surface.shading_normal;
    if (found.material->has_maps) {
        *with_maps = textured(*scene.scene, kind, surface, incoming, width);
        normal = mapped_normal(*scene.scene, kind, surface, incoming, width);
    }
    return {surface,       kind,      found.material->has_maps ? *with_maps : found.material->plain,
            side * normal, geometric, incoming};
}

// Lets a new ray leave the point, off its surface. In place: a copy of a ray just put together
// makes processors wait for its parts.
inline void set_leaving(const ShadingPoint& point, const glm::vec3& direction, Ray& ray) {
    ray.origin = offset_origin(point.surface, direction);
    ray.direction = direction;
}
inline Ray leaving(const ShadingPoint& point, const glm::vec3& direction) {
    Ray ray;
    set_leaving(point, direction, ray);
    return ray;
}

}  // namespace raypick
