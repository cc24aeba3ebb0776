#include "tracer/shade/shade_scene.h"

#include "tracer/accel/shape_surfaces.h"
#include "tracer/accel/triangle_surfaces.h"
#include "tracer/shade/interior.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>

namespace raypick {

namespace {

PreparedMaterial prepared(const Scene& scene, const Material& material,
                          const RenderSettings& settings) {
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
    result.only_mirrors = settings.reflections && material.reflects() && !material.transmits() &&
                          material.reflectance == Reflectance::constant && !result.has_maps &&
                          result.plain.opacity == 1.0f;
    result.mirrored = result.plain.reflect;
    result.own = own_light(scene, result.plain);
    return result;
}

SurfaceKind kind_of(const HitObject& at) {
    if (TriangleSurfaces::takes(at)) return SurfaceKind::triangle;
    switch (ShapeSurfaces::kind(at)) {
        case ShapeSurfaces::Kind::sphere:
            return SurfaceKind::sphere;
        case ShapeSurfaces::Kind::rectangle:
            return SurfaceKind::rectangle;
        case ShapeSurfaces::Kind::other:
            break;
    }
    return SurfaceKind::other;
}

Clearness clearness_of(const ShadeScene& scene) {
    std::vector<std::uint8_t> materials;
    for (const PreparedMaterial& material : scene.materials)
        materials.push_back(material.see_through ? 1 : 0);
    return clearness(*scene.scene, std::move(materials));
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
        result.materials.push_back(prepared(accel.scene(), material, settings));
        if (result.materials.back().has_maps) result.has_maps = true;
        if (settings.refractions && result.materials.back().fills) result.has_bodies = true;
        if (result.materials.back().see_through) result.sees_through = true;
    }
    result.materials.push_back(
        prepared(accel.scene(), material(accel.scene(), kNoMaterial), settings));
    if (result.tints_shadows()) result.clear = clearness_of(result);
    return result;
}

KnownPart part_at(const ShadeScene& scene, const Hit& hit) {
    const std::size_t index = object_index(*scene.scene, hit.object);
    KnownPart known;
    known.object = &scene.scene->objects[index];
    known.object_from_world = &scene.accel->object_from_world(index);
    known.last = std::numeric_limits<std::uint32_t>::max();
    known.material = known.object->material;
    if (known.material == kNoMaterial) {
        const Part* part = part_of(parts_of(*scene.scene, known.object->shape), hit.primitive);
        if (part != nullptr) {
            known.material = part->material;
            known.first = part->first;
            known.last = part->first + (part->count - 1);
        } else {
            known.first = known.last = hit.primitive;
        }
    }
    const PreparedMaterial& material = prepared_material(scene, known.material);
    known.prepared = &material;
    known.kind = kind_of(known.at());
    if (known.kind == SurfaceKind::triangle) {
        known.mesh = &scene.scene->meshes[std::get<MeshInstance>(known.object->shape).mesh];
    }
    // What bounds a body sends rays through it.
    known.simple = !material.has_maps && (!material.branches || material.only_mirrors);
    return known;
}

FoundHit find_surface(const ShadeScene& scene, const Ray& ray, const Hit& hit) {
    const KnownPart part = part_at(scene, hit);
    FoundHit found;
    found.object = part.object;
    found.material = part.prepared;
    set_surface_point(*scene.scene, part.at(), ray, hit, found.surface);
    return found;
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
