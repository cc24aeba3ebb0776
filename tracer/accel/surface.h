// What a hit looks like from close by: computed on demand from a Hit.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"
#include "tracer/scene/scene.h"

namespace raypick {

struct SurfacePoint {
    glm::vec3 position{0.0f};          // scene space, on the surface to float rounding
    glm::vec3 position_error{0.0f};    // bound on |position - the exact point|, per axis
    glm::vec3 geometric_normal{0.0f};  // unit, outward
    glm::vec3 shading_normal{0.0f};    // unit, interpolated on meshes with normals, outward
    glm::vec2 uv{0.0f};                // the hit's uv
    glm::vec2 texture_uv{0.0f};        // the mesh's uv there; the hit's on other shapes
    glm::vec3 dpdu{0.0f};  // scene-space derivatives of the position by texture_uv; 0 on
    glm::vec3 dpdv{0.0f};  // meshes without uv and where uv is degenerate
    bool front_face = true;
    MaterialId material = kNoMaterial;
};

// `hit` must come from this ray and this scene.
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit);

// What is known of a hit's object already.
struct HitObject {
    const Object& object;
    const Transform& object_from_world;  // the inverse of the object's transform
    MaterialId material = kNoMaterial;   // of the hit's primitive
    bool textured = true;                // false: texture_uv, dpdu and dpdv may be left 0
};
// The same without looking it up again.
SurfacePoint surface_point(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit);

// Origin for a ray that leaves the surface on the side that `direction` points to: moved off by the
// point's own error bound and no more. Source: Pharr, Jakob, Humphreys, Physically Based Rendering,
// 4th ed. 2023, section 6.8.
glm::vec3 offset_origin(const SurfacePoint& point, const glm::vec3& direction);

// The uv that textures are looked up by.
glm::vec2 texture_uv(const Scene& scene, const Object& object, const Hit& hit);

// What a ray's cone of diameter `width` covers around the point, in texture_uv: an ellipse with the
// axes width along cross(n, d) and width / |cos| along d's shadow on the surface (n the geometric
// normal, cos = n.d, at least 1/64). 0 where dpdu and dpdv are. The GLSL twin is footprint() in
// shaders/texture.glsl.
Footprint footprint(const SurfacePoint& point, const glm::vec3& direction, float width);

}  // namespace raypick
