#include "tracer/io/gltf_material.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string_view>
#include <vector>

namespace raypick {

namespace {

constexpr double kLargestColour = 1e18;

constexpr NumberRule kFraction{0.0, 1.0, true, "a number between 0 and 1"};
constexpr NumberRule kNotNegative{0.0, kLargestColour, true, "a number, 0 or more"};

double fraction(const JsonValue& object, std::string_view key, double otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    return value ? value->number(kFraction) : otherwise;
}

double not_negative(const JsonValue& object, std::string_view key, double otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    return value ? value->number(kNotNegative) : otherwise;
}

void read_base(const JsonValue& json, GltfMaterial& material) {
    const std::optional<JsonValue> pbr = json.find("pbrMetallicRoughness");
    if (!pbr) return;
    if (const std::optional<JsonValue> colour = pbr->find("baseColorFactor")) {
        const std::vector<JsonValue> rgba = colour->elements(4, "four numbers");
        material.base = glm::vec3(rgba[0].number(kFraction), rgba[1].number(kFraction),
                                  rgba[2].number(kFraction));
        material.alpha = rgba[3].number(kFraction);
    }
    material.metallic = fraction(*pbr, "metallicFactor", 1.0);
    material.roughness = fraction(*pbr, "roughnessFactor", 1.0);
    material.metallic_texture = pbr->find("metallicRoughnessTexture").has_value();
}

void read_emissive(const JsonValue& json, GltfMaterial& material) {
    if (const std::optional<JsonValue> colour = json.find("emissiveFactor")) {
        const std::vector<JsonValue> rgb = colour->elements(3, "three numbers");
        material.emissive = glm::vec3(rgb[0].number(kNotNegative), rgb[1].number(kNotNegative),
                                      rgb[2].number(kNotNegative));
    }
    if (const auto strength = extension(json, "KHR_materials_emissive_strength")) {
        material.emissive *= static_cast<float>(not_negative(*strength, "emissiveStrength", 1.0));
    }
}

void read_glass(const JsonValue& json, GltfMaterial& material) {
    if (const auto transmission = extension(json, "KHR_materials_transmission")) {
        material.transmission = fraction(*transmission, "transmissionFactor", 0.0);
    }
    if (const auto ior = extension(json, "KHR_materials_ior")) {
        const double value = not_negative(*ior, "ior", 1.5);
        // 0 is the specification's way to ask for a surface that reflects all light.
        if (value > 0.0) material.ior = value;
    }
    if (const auto volume = extension(json, "KHR_materials_volume")) {
        material.thickness = not_negative(*volume, "thicknessFactor", 0.0);
    }
}

}  // namespace

GltfMaterial read_gltf_material(const JsonValue& json) {
    GltfMaterial material;
    material.name = name_of(json);
    read_base(json, material);
    read_emissive(json, material);
    read_glass(json, material);
    if (const std::optional<JsonValue> mode = json.find("alphaMode")) {
        material.blend = mode->text() == "BLEND";
    }
    material.unlit = extension(json, "KHR_materials_unlit").has_value();
    return material;
}

}  // namespace raypick
