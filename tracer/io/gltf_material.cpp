#include "tracer/io/gltf_material.h"

#include "tracer/error.h"
#include "tracer/scene/limits.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace raypick {

namespace {

constexpr NumberRule kFraction{0.0, 1.0, true, "a number between 0 and 1"};
constexpr NumberRule kNotNegative{0.0, kMostLight, true, "a number, 0 or more"};
constexpr NumberRule kCoordinate{-1e9, 1e9, true, "a number"};

float number(const JsonValue& object, std::string_view key, const NumberRule& rule,
             double otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    return static_cast<float>(value ? value->number(rule) : otherwise);
}

std::optional<glm::vec3> colour(const JsonValue& object, std::string_view key,
                                const NumberRule& rule) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return std::nullopt;
    const std::vector<JsonValue> rgb = value->elements(3, "three numbers");
    return glm::vec3(rgb[0].number(rule), rgb[1].number(rule), rgb[2].number(rule));
}

glm::dvec2 pair(const JsonValue& object, std::string_view key, double otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value) return glm::dvec2(otherwise);
    const std::vector<JsonValue> uv = value->elements(2, "two numbers");
    return {uv[0].number(kCoordinate), uv[1].number(kCoordinate)};
}

// KHR_texture_transform: scaled, turned, then moved, in glTF's coordinates, whose v grows
// downwards: v = 1 - ours, both before and after.
void apply_transform(const JsonValue& json, GltfMap& map) {
    const glm::dvec2 offset = pair(json, "offset", 0.0);
    const glm::dvec2 scale = pair(json, "scale", 1.0);
    const std::optional<JsonValue> rotation = json.find("rotation");
    const double angle = rotation ? rotation->number(kCoordinate) : 0.0;
    const glm::dvec2 u(std::cos(angle) * scale.x, std::sin(angle) * scale.y);
    const glm::dvec2 v(-std::sin(angle) * scale.x, std::cos(angle) * scale.y);
    map.use.u_row = glm::vec3(u.x, -u.y, u.y + offset.x);
    map.use.v_row = glm::vec3(-v.x, v.y, 1.0 - v.y - offset.y);
    map.uv_set = static_cast<int>(std::min<std::uint64_t>(
        whole_number(json, "texCoord", static_cast<std::uint64_t>(map.uv_set)), 999));
}

void apply_sampler(const JsonValue& json, TextureMap& use) {
    const auto wrap = [&](std::string_view key) {
        switch (whole_number(json, key, 10497)) {
            case 33071:
                return Wrap::clamp;
            case 33648:
                return Wrap::mirror;
            default:
                return Wrap::repeat;
        }
    };
    use.wrap_u = wrap("wrapS");
    use.wrap_v = wrap("wrapT");
    constexpr std::uint64_t kNearest = 9728;
    if (whole_number(json, "magFilter", 0) == kNearest) use.filter = TextureFilter::nearest;
}

class MaterialReader {
public:
    MaterialReader(GltfDocument& document, const JsonValue& json,
                   std::vector<std::string>& warnings)
        : document_(document), json_(json), warnings_(warnings) {}

    GltfMaterial read() {
        material_.name = name_of(json_);
        read_base();
        read_emissive();
        read_glass();
        read_specular();
        read_alpha();
        material_.normal_map = map(json_, "normalTexture");
        if (material_.normal_map) {
            const JsonValue texture = json_.need("normalTexture");
            material_.normal_map->use.gain = number(texture, "scale", kCoordinate, 1.0);
        }
        material_.unlit = extension(json_, "KHR_materials_unlit").has_value();
        leave_out_other_sets();
        return std::move(material_);
    }

private:
    void read_base() {
        const std::optional<JsonValue> pbr = json_.find("pbrMetallicRoughness");
        if (!pbr) return;
        if (const std::optional<JsonValue> factor = pbr->find("baseColorFactor")) {
            const std::vector<JsonValue> rgba = factor->elements(4, "four numbers");
            material_.pbr.base = glm::vec3(rgba[0].number(kFraction), rgba[1].number(kFraction),
                                           rgba[2].number(kFraction));
            material_.alpha = static_cast<float>(rgba[3].number(kFraction));
        }
        material_.pbr.metallic = number(*pbr, "metallicFactor", kFraction, 1.0);
        material_.pbr.roughness = number(*pbr, "roughnessFactor", kFraction, 1.0);
        material_.base_map = map(*pbr, "baseColorTexture");
        material_.metallic_roughness_map = map(*pbr, "metallicRoughnessTexture");
    }

    void read_emissive() {
        material_.emissive =
            colour(json_, "emissiveFactor", kNotNegative).value_or(glm::vec3(0.0f));
        if (const auto strength = extension(json_, "KHR_materials_emissive_strength")) {
            material_.emissive = glm::min(
                material_.emissive * number(*strength, "emissiveStrength", kNotNegative, 1.0),
                glm::vec3(static_cast<float>(kMostLight)));
        }
        material_.emissive_map = map(json_, "emissiveTexture");
    }

    void read_glass() {
        if (const auto transmission = extension(json_, "KHR_materials_transmission")) {
            material_.pbr.transmission =
                number(*transmission, "transmissionFactor", kFraction, 0.0);
            material_.transmission_map = map(*transmission, "transmissionTexture");
        }
        if (const auto ior = extension(json_, "KHR_materials_ior")) {
            read_ior(*ior);
        }
        if (const auto volume = extension(json_, "KHR_materials_volume")) {
            material_.thickness =
                static_cast<double>(number(*volume, "thicknessFactor", kNotNegative, 0.0));
            read_absorption(*volume);
            leave_out(*volume, "thicknessTexture");
        }
    }

    // 0 is the specification's way to ask for a surface that reflects all light.
    void read_ior(const JsonValue& extension) {
        constexpr NumberRule kIndex{kSmallestPositive, kMostLight, true, "0 or a positive number"};
        const std::optional<JsonValue> ior = extension.find("ior");
        if (ior && !ior->equals(0)) material_.ior = ior->number(kIndex);
    }

    // Without a distance nothing is absorbed. Of a channel that is 0 nothing would be left at any
    // distance.
    void read_absorption(const JsonValue& volume) {
        const std::optional<JsonValue> distance = volume.find("attenuationDistance");
        if (!distance) return;
        constexpr NumberRule kPositive{0.0, 1e30, false, "a positive number"};
        const double length = distance->number(kPositive);
        const glm::vec3 left =
            colour(volume, "attenuationColor", kFraction).value_or(glm::vec3(1.0f));
        for (int i = 0; i < 3; ++i) {
            const double per_length = -std::log(static_cast<double>(left[i])) / length;
            material_.absorption[i] =
                static_cast<float>(std::clamp(per_length, 0.0, kMostAbsorption));
        }
    }

    void read_specular() {
        const double root = (material_.ior - 1.0) / (material_.ior + 1.0);
        if (const auto specular = extension(json_, "KHR_materials_specular")) {
            material_.pbr.tint =
                colour(*specular, "specularColorFactor", kNotNegative).value_or(glm::vec3(1.0f)) *
                number(*specular, "specularFactor", kFraction, 1.0);
            leave_out(*specular, "specularTexture");
            leave_out(*specular, "specularColorTexture");
        }
        material_.pbr.f0 =
            glm::min(static_cast<float>(root * root) * material_.pbr.tint, glm::vec3(1.0f));
    }

    void read_alpha() {
        if (const std::optional<JsonValue> mode = json_.find("alphaMode")) {
            material_.blend = mode->text() == "BLEND";
            material_.masked = mode->text() == "MASK";
        }
        material_.alpha_cutoff = number(json_, "alphaCutoff", kNotNegative, 0.5);
    }

    std::optional<GltfMap> map(const JsonValue& object, std::string_view key) {
        const std::optional<JsonValue> json = object.find(key);
        if (!json) return std::nullopt;
        GltfMap map;
        map.uv_set =
            static_cast<int>(std::min<std::uint64_t>(whole_number(*json, "texCoord", 0), 999));
        const JsonValue& texture =
            document_.array("textures")[document_.index(json->need("index"), "textures")];
        map.image = document_.texture_image(texture);
        if (const std::optional<JsonValue> sampler = texture.find("sampler")) {
            apply_sampler(document_.array("samplers")[document_.index(*sampler, "samplers")],
                          map.use);
        }
        if (const auto transform = extension(*json, "KHR_texture_transform")) {
            apply_transform(*transform, map);
        }
        return map;
    }

    void leave_out(const JsonValue& object, std::string_view key) {
        if (object.find(key)) warn(key, "is not read");
    }

    void leave_out_other_sets() {
        const int set = material_.uv_set();
        const auto check = [&](std::optional<GltfMap>& map, std::string_view key) {
            if (!map || map->uv_set == set) return;
            warn(key,
                 fmt::format("has texture coordinates {}, but the mesh is shown with {}: left out",
                             map->uv_set, set));
            map.reset();
        };
        if (material_.metallic_roughness_map && material_.metallic_roughness_map->uv_set != set) {
            material_.pbr.metallic = 0.0f;  // the texture says where there is metal
        }
        check(material_.metallic_roughness_map, "metallicRoughnessTexture");
        if (material_.transmission_map && material_.transmission_map->uv_set != set) {
            material_.pbr.transmission = 0.0f;
        }
        check(material_.transmission_map, "transmissionTexture");
        check(material_.normal_map, "normalTexture");
        check(material_.emissive_map, "emissiveTexture");
    }

    void warn(std::string_view key, const std::string& text) {
        warnings_.push_back(
            fmt::format("{}: material \"{}\": {} {}", document_.file(), material_.name, key, text));
    }

    GltfDocument& document_;
    const JsonValue& json_;
    std::vector<std::string>& warnings_;
    GltfMaterial material_;
};

}  // namespace

GltfMaterial read_gltf_material(GltfDocument& document, const JsonValue& json,
                                std::vector<std::string>& warnings) {
    return MaterialReader(document, json, warnings).read();
}

}  // namespace raypick
