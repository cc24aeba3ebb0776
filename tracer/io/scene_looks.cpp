#include "tracer/io/scene_looks.h"

#include "tracer/error.h"
#include "tracer/io/embedded_array.h"
#include "tracer/io/scene_numbers.h"
#include "tracer/io/texture_file.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <utility>

namespace raypick {

namespace {

constexpr NumberRule kTexels{1.0, 65536.0, true, "a whole number from 1 to 65536"};
constexpr NumberRule kChannel{0.0, 3.0, true, "a channel: 0, 1, 2 or 3"};
constexpr NumberRule kPriority{-1e9, 1e9, true, "a whole number between -1e9 and 1e9"};

void warn(const JsonValue& value, const ImageFolder& images, const Error& error,
          std::string_view instead) {
    images.warnings->push_back(fmt::format("{}: {}: {}; {} is shown instead", images.scene_file,
                                           value.place(), error.what(), instead));
}

struct TexelCounts {
    int rows = 0;
    int cols = 0;

    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    }
};

TexelCounts read_texel_counts(const JsonValue& value) {
    return {static_cast<int>(value.need("rows").whole_number(kTexels)),
            static_cast<int>(value.need("cols").whole_number(kTexels))};
}

// The embedded texels of a texture or a sky, as many as there should be.
template <typename Texel, typename Number>
std::vector<Texel> read_texels(const JsonValue& value, const TexelCounts& size) {
    const JsonValue text = value.need("texels");
    std::vector<Texel> texels = decode_array<Texel, Number>(text);
    if (texels.size() != size.count()) {
        text.fail(fmt::format("holds {} texels, but {} x {} are {}", texels.size(), size.rows,
                              size.cols, size.count()));
    }
    return texels;
}

// "file", or texels and what they came from.
bool is_embedded(const JsonValue& value) {
    const std::optional<JsonValue> texels = value.find("texels");
    const std::optional<JsonValue> file = value.find("file");
    if (!texels && !file) value.fail("give either file or rows, cols and texels");
    if (texels && file) file->fail("give either file or rows, cols and texels");
    return texels.has_value();
}

ImageTexture read_image_texture(const JsonValue& value, const ImageFolder& images) {
    value.only_keys("an image texture",
                    Keys{"name", "type", "file", "coding", "rows", "cols", "texels", "source"});
    TexelCoding coding = TexelCoding::srgb;
    if_present(value, "coding", [&](const JsonValue& word) {
        coding = read_word<TexelCoding>(word, {"srgb", "linear", "logarithmic"});
    });
    ImageTexture image;
    if (is_embedded(value)) {
        const TexelCounts size = read_texel_counts(value);
        image.pixels = make_texture_pixels(
            size.rows, size.cols, read_texels<glm::u8vec4, std::uint8_t>(value, size), coding);
        if_present(value, "source", [&](const JsonValue& file) { image.file = file.text(); });
        return image;
    }
    const JsonValue file = value.need("file");
    image.file = images.folder / file.text();
    try {
        image.pixels = read_texture(image.file, coding);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        warn(file, images, error, "a checker of magenta and black");
        image.pixels = placeholder_texture();
    }
    return image;
}

// [r, g, b], [r, g, b, alpha] or one number.
glm::vec4 read_rgba(const JsonValue& value) {
    if (!value.is_array() || value.elements().size() != 4) {
        return {read_colour(value, kFraction), 1.0f};
    }
    const std::vector<JsonValue> rgba = value.elements();
    return {read_float(rgba[0], kFraction), read_float(rgba[1], kFraction),
            read_float(rgba[2], kFraction), read_float(rgba[3], kFraction)};
}

Checker read_checker(const JsonValue& value) {
    value.only_keys("a checker", Keys{"name", "type", "even", "odd"});
    Checker checker;
    if_present(value, "even", [&](const JsonValue& c) { checker.even = read_rgba(c); });
    if_present(value, "odd", [&](const JsonValue& c) { checker.odd = read_rgba(c); });
    return checker;
}

glm::vec3 read_row(const JsonValue& value) {
    const glm::vec3 row(read_point(value));
    return row;
}

// Two numbers [u, v], or one for both.
glm::vec2 read_pair(const JsonValue& value) {
    if (value.is_number()) return glm::vec2(read_float(value, kCoordinate));
    const std::vector<JsonValue> uv = value.elements(2, "two numbers [u, v] or one");
    return {read_float(uv[0], kCoordinate), read_float(uv[1], kCoordinate)};
}

void read_wrap(const JsonValue& value, TextureMap& map) {
    const Keys words{"repeat", "clamp", "mirror"};
    if (value.is_string()) {
        map.wrap_u = map.wrap_v = read_word<Wrap>(value, words);
        return;
    }
    const std::vector<JsonValue> uv = value.elements(2, "a way to wrap, or two [u, v]");
    map.wrap_u = read_word<Wrap>(uv[0], words);
    map.wrap_v = read_word<Wrap>(uv[1], words);
}

void read_placement(const JsonValue& value, TextureMap& map) {
    if_present(value, "scale", [&](const JsonValue& scale) {
        const glm::vec2 factors = read_pair(scale);
        map.u_row.x = factors.x;
        map.v_row.y = factors.y;
    });
    if_present(value, "offset", [&](const JsonValue& offset) {
        const glm::vec2 uv = read_pair(offset);
        map.u_row.z = uv.x;
        map.v_row.z = uv.y;
    });
    for (const std::string_view key : {"u_row", "v_row"}) {
        if_present(value, key, [&](const JsonValue& row) {
            if (value.find("scale") || value.find("offset")) {
                row.fail("give either u_row and v_row or scale and offset");
            }
            (key == "u_row" ? map.u_row : map.v_row) = read_row(row);
        });
    }
}

TextureMap read_map(const JsonValue& value, const References& textures) {
    TextureMap map;
    if (!value.is_object()) {
        map.texture = textures.read(value);
        return map;
    }
    value.only_keys("a texture map", Keys{"texture", "scale", "offset", "u_row", "v_row", "wrap",
                                          "filter", "channel", "base", "gain"});
    map.texture = textures.read(value.need("texture"));
    read_placement(value, map);
    if_present(value, "wrap", [&](const JsonValue& wrap) { read_wrap(wrap, map); });
    if_present(value, "filter", [&](const JsonValue& word) {
        map.filter = read_word<TextureFilter>(word, {"nearest", "linear"});
    });
    if_present(value, "channel", [&](const JsonValue& channel) {
        map.channel = static_cast<int>(channel.whole_number(kChannel));
    });
    if_present(value, "base", [&](const JsonValue& n) { map.base = read_float(n, kCoordinate); });
    if_present(value, "gain", [&](const JsonValue& n) { map.gain = read_float(n, kCoordinate); });
    return map;
}

void read_maps(const JsonValue& value, Material& material, const References& textures) {
    value.only_keys("an object of maps", Keys(kSlotNames.begin(), kSlotNames.end()));
    for (std::size_t slot = 0; slot < kMapSlots; ++slot) {
        if_present(value, kSlotNames[slot],
                   [&](const JsonValue& map) { material.maps[slot] = read_map(map, textures); });
    }
}

void read_colours(const JsonValue& value, Material& material) {
    const auto read_if_present = [&value](std::string_view key, const NumberRule& rule,
                                          glm::vec3& target) {
        if_present(value, key, [&](const JsonValue& c) { target = read_colour(c, rule); });
    };
    read_if_present("diffuse", kSurfaceColour, material.diffuse);
    material.ambient = material.diffuse;
    read_if_present("ambient", kSurfaceColour, material.ambient);
    read_if_present("specular", kSurfaceColour, material.specular);
    read_if_present("emissive", kNotNegative, material.emissive);
    read_if_present("reflect", kBounce, material.reflect);
    read_if_present("transmit", kBounce, material.transmit);
    read_if_present("absorption", kNotNegative, material.absorption);
}

void read_alpha(const JsonValue& value, Material& material) {
    if_present(value, "opacity",
               [&](const JsonValue& n) { material.opacity = read_float(n, kFraction); });
    if_present(value, "alpha_mode", [&](const JsonValue& word) {
        material.alpha_mode = read_word<AlphaMode>(word, {"cut_out", "blend"});
    });
    if_present(value, "alpha_cutoff",
               [&](const JsonValue& n) { material.alpha_cutoff = read_float(n, kNotNegative); });
}

// Stands for a sky that can't be read.
std::shared_ptr<const SkyPixels> placeholder_sky() {
    constexpr int kRows = 8;
    constexpr int kCols = 16;
    std::vector<glm::vec3> texels;
    for (int row = 0; row < kRows; ++row) {
        for (int col = 0; col < kCols; ++col) {
            const bool even = (row + col) % 2 == 0;
            texels.emplace_back(even ? glm::vec3(1.0f, 0.0f, 1.0f) : glm::vec3(0.0f));
        }
    }
    return make_sky_pixels(kRows, kCols, std::move(texels));
}

void check_forward(const JsonValue& value, const ImageSky& sky) {
    if (glm::cross(glm::normalize(sky.up), glm::normalize(sky.forward)) != glm::dvec3(0.0)) return;
    value.find("forward").value_or(value).fail("forward must not be parallel to up");
}

ImageSky read_image_sky(const JsonValue& value, const ImageFolder& images) {
    value.only_keys("an image around the scene", Keys{"type", "file", "rows", "cols", "texels",
                                                      "source", "up", "forward", "scale"});
    ImageSky sky;
    if_present(value, "up", [&](const JsonValue& up) { sky.up = read_direction(up); });
    if_present(value, "forward", [&](const JsonValue& f) { sky.forward = read_direction(f); });
    check_forward(value, sky);
    if_present(value, "scale",
               [&](const JsonValue& scale) { sky.scale = read_float(scale, kNotNegative); });
    if (is_embedded(value)) {
        const TexelCounts size = read_texel_counts(value);
        auto texels = read_texels<glm::vec3, float>(value, size);
        try {
            sky.pixels = make_sky_pixels(size.rows, size.cols, std::move(texels));
        } catch (const Error& error) {
            value.need("texels").fail(error.what());
        }
        if_present(value, "source", [&](const JsonValue& file) { sky.file = file.text(); });
        return sky;
    }
    const JsonValue file = value.need("file");
    sky.file = images.folder / file.text();
    try {
        sky.pixels = read_sky(sky.file);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        warn(file, images, error, "a checker of magenta and black");
        sky.pixels = placeholder_sky();
    }
    return sky;
}

GradientSky read_gradient_sky(const JsonValue& value) {
    value.only_keys("a gradient", Keys{"type", "zenith", "horizon", "ground", "up"});
    GradientSky sky;
    if_present(value, "zenith", [&](const JsonValue& c) { sky.zenith = read_colour(c); });
    if_present(value, "horizon", [&](const JsonValue& c) { sky.horizon = read_colour(c); });
    if_present(value, "ground", [&](const JsonValue& c) { sky.ground = read_colour(c); });
    if_present(value, "up", [&](const JsonValue& up) { sky.up = read_direction(up); });
    return sky;
}

}  // namespace

Texture read_scene_texture(const JsonValue& value, std::string name, const ImageFolder& images) {
    Texture texture;
    texture.name = std::move(name);
    if (value.need("type").one_of(Keys{"image", "checker"}) == "image") {
        texture.source = read_image_texture(value, images);
    } else {
        texture.source = read_checker(value);
    }
    return texture;
}

Material read_material(const JsonValue& value, std::string name, const References& textures) {
    value.only_keys("a material", Keys{"name", "ambient", "diffuse", "specular", "shininess",
                                       "emissive", "reflect", "transmit", "ior", "model",
                                       "reflectance", "thin_walled", "absorption", "priority",
                                       "opacity", "alpha_mode", "alpha_cutoff", "maps"});
    Material material;
    material.name = std::move(name);
    if_present(value, "name", [&](const JsonValue& n) { material.name = n.text_or_empty(); });
    read_colours(value, material);
    if_present(value, "shininess", [&](const JsonValue& shininess) {
        material.shininess = read_float(shininess, kNotNegative);
    });
    if_present(value, "ior",
               [&](const JsonValue& ior) { material.ior = read_float(ior, kPositive); });
    if_present(value, "model", [&](const JsonValue& word) {
        material.model = read_word<LocalModel>(word, {"phong", "blinn_phong"});
    });
    if_present(value, "reflectance", [&](const JsonValue& word) {
        material.reflectance =
            read_word<Reflectance>(word, {"constant", "dielectric", "conductor"});
    });
    if_present(value, "thin_walled",
               [&](const JsonValue& thin) { material.thin_walled = thin.truth(); });
    if_present(value, "priority", [&](const JsonValue& priority) {
        material.priority = static_cast<int>(priority.whole_number(kPriority));
    });
    read_alpha(value, material);
    if_present(value, "maps", [&](const JsonValue& maps) { read_maps(maps, material, textures); });
    return material;
}

Environment read_environment(const JsonValue& value, const ImageFolder& images) {
    if (!value.is_object()) value.refuse("an environment (an object)");
    if (value.need("type").one_of(Keys{"gradient", "image"}) == "gradient") {
        return read_gradient_sky(value);
    }
    return read_image_sky(value, images);
}

}  // namespace raypick
