// What scene_looks.h reads: textures, materials, the environment.
#include "tracer/io/saved_members.h"
#include "tracer/io/saved_values.h"
#include "tracer/io/scene_looks.h"

#include <array>

namespace raypick {

namespace {

// By the values of the enumerations.
constexpr std::array<const char*, 3> kCodingNames{"srgb", "linear", "logarithmic"};
constexpr std::array<const char*, 3> kWrapNames{"repeat", "clamp", "mirror"};
constexpr std::array<const char*, 3> kReflectanceNames{"constant", "dielectric", "conductor"};

template <typename Enum, std::size_t N>
const char* name_of(const std::array<const char*, N>& names, Enum value) {
    return names[static_cast<std::size_t>(value)];
}

void write_source(JsonWriter& json, const std::filesystem::path& file) {
    if (!file.empty()) write_member(json, "source", file.string());
}

void write_image(JsonWriter& json, const ImageTexture& image) {
    write_member(json, "type", "image");
    if (image.pixels->coding != TexelCoding::srgb) {
        write_member(json, "coding", name_of(kCodingNames, image.pixels->coding));
    }
    const TextureLevel& level = image.pixels->levels.at(0);
    write_member(json, "rows", static_cast<std::uint32_t>(level.rows));
    write_member(json, "cols", static_cast<std::uint32_t>(level.cols));
    const std::size_t count =
        static_cast<std::size_t>(level.rows) * static_cast<std::size_t>(level.cols);
    const std::span<const glm::u8vec4> texels(image.pixels->texels);
    write_array<std::uint8_t>(json, "texels", texels.subspan(level.first, count));
    write_source(json, image.file);
}

void write_checker(JsonWriter& json, const Checker& checker) {
    write_member(json, "type", "checker");
    write_member(json, "even", checker.even);
    write_member(json, "odd", checker.odd);
}

void write_wrap(JsonWriter& json, const TextureMap& map) {
    if (map.wrap_u == Wrap::repeat && map.wrap_v == Wrap::repeat) return;
    json.key("wrap");
    json.open_array(kOneLine);
    json.text(name_of(kWrapNames, map.wrap_u));
    json.text(name_of(kWrapNames, map.wrap_v));
    json.close_array();
}

void write_map(JsonWriter& json, const TextureMap& map) {
    const TextureMap defaults;
    json.open_object(kOneLine);
    write_member(json, "texture", map.texture);
    if (map.u_row != defaults.u_row) write_member(json, "u_row", map.u_row);
    if (map.v_row != defaults.v_row) write_member(json, "v_row", map.v_row);
    write_wrap(json, map);
    if (map.filter == TextureFilter::nearest) write_member(json, "filter", "nearest");
    if (map.channel != 0) write_member(json, "channel", static_cast<std::uint32_t>(map.channel));
    if (map.base != defaults.base) write_member(json, "base", map.base);
    if (map.gain != defaults.gain) write_member(json, "gain", map.gain);
    json.close_object();
}

void write_maps(JsonWriter& json, const Material& material) {
    if (material.maps == Material{}.maps) return;
    json.key("maps");
    json.open_object();
    for (std::size_t slot = 0; slot < kMapSlots; ++slot) {
        if (!material.maps[slot]) continue;
        json.key(kSlotNames[slot]);
        write_map(json, material.maps[slot]);
    }
    json.close_object();
}

// What only few materials have.
void write_extras(JsonWriter& json, const Material& material) {
    const Material defaults;
    if (material.model == LocalModel::blinn_phong) write_member(json, "model", "blinn_phong");
    if (material.reflectance != defaults.reflectance) {
        write_member(json, "reflectance", name_of(kReflectanceNames, material.reflectance));
    }
    if (material.thin_walled) write_member(json, "thin_walled", true);
    if (material.absorption != defaults.absorption) {
        write_member(json, "absorption", material.absorption);
    }
    if (material.priority != defaults.priority) {
        write_member(json, "priority", static_cast<double>(material.priority));
    }
    if (material.opacity != defaults.opacity) write_member(json, "opacity", material.opacity);
    if (material.alpha_mode == AlphaMode::blend) write_member(json, "alpha_mode", "blend");
    if (material.alpha_cutoff != defaults.alpha_cutoff) {
        write_member(json, "alpha_cutoff", material.alpha_cutoff);
    }
}

void write_sky(JsonWriter& json, const GradientSky& sky) {
    write_member(json, "type", "gradient");
    write_member(json, "zenith", sky.zenith);
    write_member(json, "horizon", sky.horizon);
    write_member(json, "ground", sky.ground);
    write_member(json, "up", sky.up);
}

void write_sky(JsonWriter& json, const ImageSky& sky) {
    write_member(json, "type", "image");
    write_member(json, "rows", static_cast<std::uint32_t>(sky.pixels->rows));
    write_member(json, "cols", static_cast<std::uint32_t>(sky.pixels->cols));
    write_array<float>(json, "texels", std::span<const glm::vec3>(sky.pixels->texels));
    write_source(json, sky.file);
    write_member(json, "up", sky.up);
    write_member(json, "forward", sky.forward);
    write_member(json, "scale", sky.scale);
}

void write_sky(JsonWriter&, const std::monostate&) {}

}  // namespace

void write_value(JsonWriter& json, const Texture& texture) {
    json.open_object();
    write_member(json, "name", texture.name);
    if (const auto* image = std::get_if<ImageTexture>(&texture.source)) {
        write_image(json, *image);
    } else {
        write_checker(json, std::get<Checker>(texture.source));
    }
    json.close_object();
}

void write_value(JsonWriter& json, const Material& material) {
    json.open_object();
    write_member(json, "name", material.name);
    write_member(json, "ambient", material.ambient);
    write_member(json, "diffuse", material.diffuse);
    write_member(json, "specular", material.specular);
    write_member(json, "shininess", material.shininess);
    write_member(json, "emissive", material.emissive);
    write_member(json, "reflect", material.reflect);
    write_member(json, "transmit", material.transmit);
    write_member(json, "ior", material.ior);
    write_extras(json, material);
    write_maps(json, material);
    json.close_object();
}

void write_value(JsonWriter& json, const Environment& environment) {
    json.open_object();
    std::visit([&json](const auto& sky) { write_sky(json, sky); }, environment);
    json.close_object();
}

}  // namespace raypick
