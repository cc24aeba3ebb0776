#include "tracer/shade/shade_scene.h"

#include "tracer/shade/interior.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace raypick {

namespace {

PreparedMaterial prepared(const Material& material, const RenderSettings& settings) {
    PreparedMaterial result;
    result.material = &material;
    result.plain = plain(material);
    result.has_maps = std::any_of(material.maps.begin(), material.maps.end(),
                                  [](const TextureMap& map) { return static_cast<bool>(map); });
    result.fills = fills(material);
    result.see_through =
        material.transmits() || (material.alpha_mode == AlphaMode::blend &&
                                 (material.opacity < 1.0f || material.map(MapSlot::opacity)));
    result.branches = (settings.refractions && result.see_through) ||
                      (settings.reflections && (material.reflects() || material.transmits()));
    return result;
}

// Notes what was hit, and says what is known of it.
HitObject hit_object(const ShadeScene& scene, const Hit& hit, FoundHit& found) {
    const std::size_t index = object_index(*scene.scene, hit.object);
    const Object& object = scene.scene->objects[index];
    const MaterialId id = material_id(*scene.scene, object, hit.primitive);
    found.object = &object;
    found.material = &prepared_material(scene, id);
    return {object, scene.accel->object_from_world(index), id, found.material->has_maps};
}

}  // namespace

ShadeScene shade_scene(const Accel& accel, std::span<const Light> lights,
                       const RenderSettings& settings) {
    ShadeScene result;
    result.accel = &accel;
    result.scene = &accel.scene();
    result.settings = settings;
    result.plain_sky = std::holds_alternative<std::monostate>(accel.scene().environment);
    for (const Light& light : lights) {
        result.lights.push_back(prepared(light));
        if (result.lights.back().count() > 1) result.draws_lots = true;
    }
    const std::vector<Material>& materials = accel.scene().materials;
    result.materials.reserve(materials.size() + 1);
    for (const Material& material : materials) {
        result.materials.push_back(prepared(material, settings));
        if (settings.refractions && result.materials.back().fills) result.has_bodies = true;
    }
    result.materials.push_back(prepared(material(accel.scene(), kNoMaterial), settings));
    return result;
}

FoundHit find_surface(const ShadeScene& scene, const Ray& ray, const Hit& hit) {
    FoundHit found;
    set_surface_point(*scene.scene, hit_object(scene, hit, found), ray, hit, found.surface);
    return found;
}

void find_surfaces(const ShadeScene& scene, std::span<const Ray> rays, std::span<const Hit> hits,
                   std::span<FoundHit> found, TriangleSurfaces& triangles) {
    triangles.clear();
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) continue;
        const HitObject at = hit_object(scene, hits[i], found[i]);
        if (TriangleSurfaces::takes(at)) {
            triangles.add(*scene.scene, at, rays[i], hits[i], found[i].surface);
        } else {
            set_surface_point(*scene.scene, at, rays[i], hits[i], found[i].surface);
        }
    }
    triangles.find(*scene.scene);
}

glm::vec3 passed(const ShadeScene& scene, MaterialId medium, float distance) {
    glm::vec3 share(1.0f);
    if (medium == kNoMaterial) return share;
    const glm::vec3& absorption = prepared_material(scene, medium).material->absorption;
    for (int i = 0; i < 3; ++i) {
        if (absorption[i] > 0.0f) share[i] = std::exp(-absorption[i] * distance);
    }
    return share;
}

}  // namespace raypick
