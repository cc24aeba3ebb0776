// What shading looks up at every hit, worked out once a frame.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/crossings.h"
#include "tracer/accel/surface.h"
#include "tracer/shade/light_sample.h"
#include "tracer/shade/settings.h"
#include "tracer/shade/textured.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

struct PreparedMaterial {
    const Material* material = nullptr;
    SurfaceMaterial plain;  // without its maps
    bool has_maps = false;
    bool fills = false;        // a body: see fills() in interior.h
    bool see_through = false;  // lets some of a light through, where shadows are tinted
    bool branches = false;     // may send rays on, by the settings
    // Sends on one mirrored ray and nothing else, with the same share of what comes along it
    // everywhere.
    bool only_mirrors = false;
    glm::vec3 mirrored{0.0f};
    glm::vec3 own{0.0f};  // light that the surface gives off by itself, without its maps
};

// A frame's scene, lights and settings as shading sees them. Immutable while rays are traced.
struct ShadeScene {
    const Accel* accel = nullptr;
    const Scene* scene = nullptr;
    RenderSettings settings;
    std::vector<PreparedLight> lights;
    std::vector<PreparedMaterial> materials;  // by id; the last one is that of no id
    Clearness clear;                          // see_through, where shadows are tinted
    bool has_maps = false;                    // some of the materials do
    bool has_bodies = false;                  // rays may be inside of something
    bool sees_through = false;                // some of the materials let light through
    bool draws_lots = false;                  // points on lights are random
    bool plain_sky = false;                   // the background is all that is around

    [[nodiscard]] bool tints_shadows() const {
        return settings.glass_shadows == GlassShadows::tinted && sees_through;
    }
};

// `lights` as from effective_lights. `accel` must outlive the result.
ShadeScene shade_scene(const Accel& accel, std::span<const Light> lights,
                       const RenderSettings& settings);

inline const PreparedMaterial& prepared_material(const ShadeScene& scene, MaterialId id) {
    return id < scene.materials.size() ? scene.materials[id] : scene.materials.back();
}

// An object's hit with what is known of it.
struct FoundHit {
    const Object* object = nullptr;
    const PreparedMaterial* material = nullptr;
    SurfacePoint surface;
};
FoundHit find_surface(const ShadeScene& scene, const Ray& ray, const Hit& hit);

// Shapes whose surface points are worked out together with others of the kind; `other`: alone.
enum class SurfaceKind : std::uint8_t { triangle, sphere, rectangle, other };

// Some primitives of an object that have one material: rays side by side mostly hit the same.
struct KnownPart {
    const Object* object = nullptr;
    const Transform* object_from_world = nullptr;
    const Mesh* mesh = nullptr;  // of the kind `triangle`
    const PreparedMaterial* prepared = nullptr;
    MaterialId material = kNoMaterial;
    std::uint32_t first = 0;  // primitives
    std::uint32_t last = 0;
    SurfaceKind kind = SurfaceKind::other;
    // It has no maps, bounds no body, and sends nothing on but by only_mirrors.
    bool simple = false;

    [[nodiscard]] bool holds(const Hit& hit) const {
        return object->id == hit.object && hit.primitive >= first && hit.primitive <= last;
    }
    [[nodiscard]] HitObject at() const {
        return {*object, *object_from_world, material, prepared->has_maps};
    }
};
// `hit` must be valid.
KnownPart part_at(const ShadeScene& scene, const Hit& hit);

// What is left after this way through a medium (Beer and Lambert's law).
glm::vec3 passed(const ShadeScene& scene, MaterialId medium, float distance);

// What a ray sees that hits nothing: see environment_colour.
inline glm::vec3 sky_colour(const ShadeScene& scene, const glm::vec3& direction, float spread) {
    if (scene.plain_sky) return scene.scene->background;
    return environment_colour(*scene.scene, direction, spread);
}

}  // namespace raypick
