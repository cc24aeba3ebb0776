// What a hit looks like from close by: computed on demand from a Hit.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/geometry/absolute.h"
#include "tracer/geometry/ray.h"
#include "tracer/scene/scene.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

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
// The same without looking it up again, written where it is wanted: a copy of what was just put
// together field by field makes processors wait.
void set_surface_point(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
                       SurfacePoint& surface);

// What a surface that no texture needs has of its hit.
inline void set_untextured(const Hit& hit, MaterialId material, SurfacePoint& surface) {
    surface.uv = hit.uv;
    surface.texture_uv = glm::vec2(0.0f);
    surface.dpdu = surface.dpdv = glm::vec3(0.0f);
    surface.front_face = hit.front_face;
    surface.material = material;
}

// The next float on the side that `way` points to; x itself if that is 0. What std::nextafter gives
// by a call.
inline float next_float(float x, float way) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    const bool finite_not_zero = (bits & 0x7fffffffu) - 1u < 0x7f7fffffu;
    if (way == 0.0f || !finite_not_zero) {
        return way == 0.0f ? x : std::nextafter(x, std::copysign(HUGE_VALF, way));
    }
    return std::bit_cast<float>((x > 0.0f) == (way > 0.0f) ? bits + 1u : bits - 1u);
}

// Origin for a ray that leaves the surface on the side that `direction` points to: moved off by the
// point's own error bound and no more. Source: Pharr, Jakob, Humphreys, Physically Based Rendering,
// 4th ed. 2023, section 6.8.
inline glm::vec3 offset_origin(const SurfacePoint& point, const glm::vec3& direction) {
    const glm::vec3 normal = glm::dot(point.geometric_normal, direction) >= 0.0f
                                 ? point.geometric_normal
                                 : -point.geometric_normal;
    // Twice the bound: once for the point, once for the rounding of the sum.
    const float distance = 2.0f * glm::dot(absolute(normal), point.position_error);
    const glm::vec3 origin = point.position + distance * normal;
    return {next_float(origin.x, normal.x), next_float(origin.y, normal.y),
            next_float(origin.z, normal.z)};
}

// The uv that textures are looked up by.
glm::vec2 texture_uv(const Scene& scene, const Object& object, const Hit& hit);

// What a ray's cone of diameter `width` covers around the point, in texture_uv: an ellipse with the
// axes width along cross(n, d) and width / |cos| along d's shadow on the surface (n the geometric
// normal, cos = n.d, at least 1/64). 0 where dpdu and dpdv are. The GLSL twin is footprint() in
// shaders/texture.glsl.
Footprint footprint(const SurfacePoint& point, const glm::vec3& direction, float width);

}  // namespace raypick
