#include "tracer/shade/shade_scene.h"

#include "tracer/shade/interior.h"

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

PreparedMaterial prepared(const Material& material) {
    PreparedMaterial result;
    result.material = &material;
    result.plain = plain(material);
    result.has_maps = std::any_of(material.maps.begin(), material.maps.end(),
                                  [](const TextureMap& map) { return static_cast<bool>(map); });
    result.fills = fills(material);
    result.see_through =
        material.transmits() || (material.alpha_mode == AlphaMode::blend &&
                                 (material.opacity < 1.0f || material.map(MapSlot::opacity)));
    return result;
}

}  // namespace

ShadeScene shade_scene(const Accel& accel, std::span<const Light> lights,
                       const RenderSettings& settings) {
    ShadeScene result;
    result.accel = &accel;
    result.scene = &accel.scene();
    result.settings = settings;
    for (const Light& light : lights) {
        result.lights.push_back(prepared(light));
        if (result.lights.back().count() > 1) result.draws_lots = true;
    }
    const std::vector<Material>& materials = accel.scene().materials;
    result.materials.reserve(materials.size() + 1);
    for (const Material& material : materials) {
        result.materials.push_back(prepared(material));
        if (settings.refractions && result.materials.back().fills) result.has_bodies = true;
    }
    result.materials.push_back(prepared(material(accel.scene(), kNoMaterial)));
    return result;
}

const PreparedMaterial& prepared_material(const ShadeScene& scene, MaterialId id) {
    return id < scene.materials.size() ? scene.materials[id] : scene.materials.back();
}

FoundHit find_surface(const ShadeScene& scene, const Ray& ray, const Hit& hit) {
    const std::size_t index = object_index(*scene.scene, hit.object);
    const Object& object = scene.scene->objects[index];
    const MaterialId id = material_id(*scene.scene, object, hit.primitive);
    const PreparedMaterial& material = prepared_material(scene, id);
    const HitObject at{object, scene.accel->object_from_world(index), id, material.has_maps};
    return {object, material, surface_point(*scene.scene, at, ray, hit)};
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
