// A material after its maps: its numbers at one point of a surface.
#pragma once

#include "tracer/accel/surface.h"
#include "tracer/scene/scene.h"

#include <glm/vec3.hpp>

namespace raypick {

// What maps may vary of a Material, under the same names.
struct SurfaceMaterial {
    glm::vec3 ambient{0.0f};
    glm::vec3 diffuse{0.0f};
    glm::vec3 specular{0.0f};
    float shininess = 0.0f;
    glm::vec3 emissive{0.0f};
    glm::vec3 reflect{0.0f};
    glm::vec3 transmit{0.0f};
    float opacity = 1.0f;
    LocalModel model = LocalModel::phong;

    [[nodiscard]] bool reflects() const { return reflect != glm::vec3(0.0f); }
    [[nodiscard]] bool transmits() const { return transmit != glm::vec3(0.0f); }
};

// Without its maps.
SurfaceMaterial plain(const Material& material);

// With its maps, for a ray that arrives in `direction` with a cone of this width at the point. Maps
// multiply; the opacity of a cut-out is 1, since where there is none the ray has no hit.
SurfaceMaterial textured(const Scene& scene, const Material& material, const SurfacePoint& surface,
                         const glm::vec3& direction, float width);

// What the surface gives off by itself: its own glow, and the ambient light on it.
inline glm::vec3 own_light(const Scene& scene, const SurfaceMaterial& material) {
    return material.emissive + material.ambient * scene.ambient;
}

// The shading normal under the material's normal map, unit, outward as surface.shading_normal N:
//   normalize(gain x T + gain y B + z N), (x, y, z) = 2 texel - 1,
// with T = dpdu made perpendicular to N and B = dpdv made perpendicular to N and T, both unit.
// N itself without a map, and where dpdu and dpdv span no plane. Scene space. The GLSL twin is
// mapped_normal() in shaders/normal_map.glsl.
glm::vec3 mapped_normal(const Scene& scene, const Material& material, const SurfacePoint& surface,
                        const glm::vec3& direction, float width);

}  // namespace raypick
