#include "tracer/shade/textured.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace raypick {

namespace {

// The maps of one material at one point.
class MapsAt {
public:
    MapsAt(const Scene& scene, const Material& material, const SurfacePoint& surface,
           const Footprint& covered)
        : scene_(scene), material_(material), uv_(surface.texture_uv), covered_(covered) {}

    void multiply(MapSlot slot, glm::vec3& colour) const {
        if (const TextureMap& map = material_.map(slot)) colour *= glm::vec3(texel(map));
    }
    void multiply(MapSlot slot, float& number) const {
        if (const TextureMap& map = material_.map(slot)) number *= texel(map)[map.channel];
    }
    [[nodiscard]] glm::vec4 texel(const TextureMap& map) const {
        return sample(scene_.textures[map.texture], map, uv_, covered_);
    }

private:
    const Scene& scene_;
    const Material& material_;
    glm::vec2 uv_;
    Footprint covered_;
};

bool has_maps(const Material& material) {
    return std::any_of(material.maps.begin(), material.maps.end(),
                       [](const TextureMap& map) { return static_cast<bool>(map); });
}

std::optional<glm::vec3> unit(const glm::vec3& v) {
    const float squared = glm::dot(v, v);
    // The derivatives of a tiny mesh are tiny; only what no longer has a direction is left out.
    if (!(squared > 1e-36f)) return std::nullopt;
    return v / std::sqrt(squared);
}

}  // namespace

SurfaceMaterial plain(const Material& material) {
    SurfaceMaterial at;
    at.ambient = material.ambient;
    at.diffuse = material.diffuse;
    at.specular = material.specular;
    at.shininess = material.shininess;
    at.emissive = material.emissive;
    at.reflect = material.reflect;
    at.transmit = material.transmit;
    if (material.alpha_mode == AlphaMode::blend) at.opacity = material.opacity;
    at.model = material.model;
    return at;
}

SurfaceMaterial textured(const Scene& scene, const Material& material, const SurfacePoint& surface,
                         const glm::vec3& direction, float width) {
    SurfaceMaterial at = plain(material);
    if (!has_maps(material)) return at;
    const MapsAt maps(scene, material, surface, footprint(surface, direction, width));
    if (const TextureMap& map = material.map(MapSlot::diffuse)) {
        const glm::vec3 texel(maps.texel(map));
        if (!material.map(MapSlot::ambient)) at.ambient *= texel;
        at.diffuse *= texel;
    }
    maps.multiply(MapSlot::ambient, at.ambient);
    maps.multiply(MapSlot::specular, at.specular);
    maps.multiply(MapSlot::shininess, at.shininess);
    at.shininess = std::max(at.shininess, std::min(material.shininess, 1.0f));
    maps.multiply(MapSlot::reflect, at.reflect);
    maps.multiply(MapSlot::transmit, at.transmit);
    maps.multiply(MapSlot::emissive, at.emissive);
    if (material.alpha_mode == AlphaMode::blend) {
        maps.multiply(MapSlot::opacity, at.opacity);
        at.opacity = std::clamp(at.opacity, 0.0f, 1.0f);
    }
    return at;
}

glm::vec3 mapped_normal(const Scene& scene, const Material& material, const SurfacePoint& surface,
                        const glm::vec3& direction, float width) {
    const glm::vec3& n = surface.shading_normal;
    const TextureMap& map = material.map(MapSlot::normal);
    if (!map) return n;
    const auto t = unit(surface.dpdu - n * glm::dot(n, surface.dpdu));
    if (!t) return n;
    const glm::vec3 across = surface.dpdv - n * glm::dot(n, surface.dpdv);
    const auto b = unit(across - *t * glm::dot(*t, across));
    if (!b) return n;
    // The gain scales the slopes, not the texel.
    TextureMap plain_map = map;
    plain_map.base = 0.0f;
    plain_map.gain = 1.0f;
    const glm::vec4 texel = sample(scene.textures[map.texture], plain_map, surface.texture_uv,
                                   footprint(surface, direction, width));
    const glm::vec3 slopes = 2.0f * glm::vec3(texel) - 1.0f;
    const glm::vec3 mapped = map.gain * (slopes.x * *t + slopes.y * *b) + slopes.z * n;
    return unit(mapped).value_or(n);
}

}  // namespace raypick
