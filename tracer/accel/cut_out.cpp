#include "tracer/accel/cut_out.h"

#include "tracer/accel/surface.h"

#include <algorithm>

namespace raypick {

namespace {

float least_opacity(const Material& material) {
    return material.alpha_mode == AlphaMode::cut_out ? material.alpha_cutoff : 1.0f / 255;
}

bool may_be_cut_out(const Material& material) {
    return material.map(MapSlot::opacity) || !(material.opacity >= least_opacity(material));
}

}  // namespace

bool may_be_cut_out(const Scene& scene, const Object& object) {
    const auto cut = [&scene](MaterialId id) { return may_be_cut_out(material(scene, id)); };
    if (object.material != kNoMaterial) return cut(object.material);
    const std::span<const Part> parts = parts_of(scene, object.shape);
    return std::any_of(parts.begin(), parts.end(),
                       [&cut](const Part& part) { return cut(part.material); });
}

bool is_cut_out(const Scene& scene, const Object& object, const Hit& hit) {
    const Material& surface = material(scene, material_id(scene, object, hit.primitive));
    float opacity = surface.opacity;
    if (const TextureMap& map = surface.map(MapSlot::opacity);
        map && map.texture < scene.textures.size()) {
        opacity *=
            sample(scene.textures[map.texture], map, texture_uv(scene, object, hit))[map.channel];
    }
    return !(opacity >= least_opacity(surface));
}

}  // namespace raypick
