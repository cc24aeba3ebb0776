#include "tracer/io/mtl_textures.h"

#include "tracer/scene/limits.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace raypick {

namespace {

TexelCoding coding_of(MtlMapKind kind) {
    switch (kind) {
        case MtlMapKind::diffuse:
        case MtlMapKind::specular:
        case MtlMapKind::emissive:
            return TexelCoding::srgb;
        default:
            return TexelCoding::linear;
    }
}

// A map of opacity means alpha if -imfchan asks for it, or if the image has some.
bool takes_alpha(const MtlMap& map, const ByteImage& image) {
    return map.channel == '\0' ? !is_uniform(image, 3) : map.channel == 'm';
}

// -mm may make more of a mirror than a scene holds.
void keep_bounce_in_range(Material& material) {
    const TextureMap& map = material.map(MapSlot::reflect);
    const glm::vec3& r = material.reflect;
    const float most =
        std::max({r.x, r.y, r.z}) * std::max(std::abs(map.base), std::abs(map.base + map.gain));
    constexpr auto kMost = static_cast<float>(kMostBounce);
    if (most > kMost) material.reflect *= 0.999f * kMost / most;
}

// How a map of opacity acts: shapes that are cut out are no surface at all.
void choose_alpha_mode(Material& material, const ByteImage& image, int channel) {
    const bool cut_out = material.opacity == 1.0f && is_nearly_binary(image, channel);
    material.alpha_mode = cut_out ? AlphaMode::cut_out : AlphaMode::blend;
}

}  // namespace

void MtlTextures::request(MaterialId material, const MtlMaterial& mtl) {
    for (const MtlMap& map : mtl.maps) {
        ImageSource source;
        source.place = map.place;
        if (auto file = find_named_file({map.folder, obj_folder_}, map.file)) {
            source.name = file->string();
            source.file = *std::move(file);
        } else {
            source.name = map.file;
            source.problem = "is missing";
        }
        wishes_.push_back({material, map, library_.image(std::move(source), coding_of(map.kind))});
    }
}

void MtlTextures::finish(const LoadOptions& options, float progress_begin, float progress_end) {
    const float middle = 0.5f * (progress_begin + progress_end);
    library_.decode(options, progress_begin, middle);
    for (const Wish& wish : wishes_)
        grant(wish);
    for (const Wish& wish : wishes_)
        cut_out_by_alpha(wish, target_->scene.materials[wish.material]);
    library_.make(options, middle, progress_end);
}

void MtlTextures::grant(const Wish& wish) {
    Material& material = target_->scene.materials[wish.material];
    const auto give = [&](MapSlot slot) {
        material.map(slot) = wish.map.use;
        material.map(slot).texture = library_.texture(wish.image);
    };
    // There is no placeholder for normals and numbers: what is broken is left out.
    const bool broken = library_.broken(wish.image);
    switch (wish.map.kind) {
        case MtlMapKind::diffuse:
            give(MapSlot::diffuse);
            break;
        case MtlMapKind::specular:
            give(MapSlot::specular);
            if (material.reflects()) {  // both are Ks
                give(MapSlot::reflect);
                keep_bounce_in_range(material);
            }
            break;
        case MtlMapKind::emissive:
            give(MapSlot::emissive);
            break;
        case MtlMapKind::bump:
        case MtlMapKind::normal:
            if (!broken) material.map(MapSlot::normal) = normals(wish);
            break;
        case MtlMapKind::shininess:
            if (!broken) material.map(MapSlot::shininess) = numbers(wish);
            break;
        case MtlMapKind::opacity:
        case MtlMapKind::transparency:
            if (!broken) give_opacity(wish, material);
            break;
    }
}

TextureMap MtlTextures::normals(const Wish& wish) {
    const std::shared_ptr<const ByteImage>& image = library_.pixels(wish.image);
    TextureMap map = wish.map.use;
    map.base = 0.0f;
    map.gain = static_cast<float>(wish.map.bump);
    if (wish.map.kind == MtlMapKind::normal || looks_like_normals(*image)) {
        map.texture = library_.texture(wish.image);
        return map;
    }
    // -mm's gain scales heights; its base lifts all of them and changes no slope.
    const double scale = wish.map.bump * static_cast<double>(wish.map.use.gain);
    map.gain = 1.0f;
    map.texture = library_.baked(
        fmt::format("normals of {} by {}", library_.name(wish.image), scale), TexelCoding::linear,
        [image, scale] { return normals_of_heights(*image, scale); });
    return map;
}

// A map of one number: the channel that -imfchan asks for, else the luminance.
TextureMap MtlTextures::numbers(const Wish& wish) {
    const std::shared_ptr<const ByteImage>& image = library_.pixels(wish.image);
    TextureMap map = wish.map.use;
    const std::size_t channel = std::string_view("rgbm").find(wish.map.channel);
    if (wish.map.channel != '\0' && channel != std::string_view::npos) {
        map.channel = static_cast<int>(channel);
        map.texture = library_.texture(wish.image);
    } else if (is_grey(*image)) {
        map.texture = library_.texture(wish.image);
    } else {
        map.texture = library_.baked(fmt::format("luminance of {}", library_.name(wish.image)),
                                     TexelCoding::linear, [image] { return luminance(*image); });
    }
    return map;
}

void MtlTextures::give_opacity(const Wish& wish, Material& material) {
    const ByteImage& image = *library_.pixels(wish.image);
    TextureMap map = wish.map.use;
    if (takes_alpha(wish.map, image)) {
        map.channel = 3;
        // The colours' texture has the same alpha, and most often the same file.
        const auto same = std::find_if(wishes_.begin(), wishes_.end(), [&](const Wish& other) {
            return other.material == wish.material && other.map.kind == MtlMapKind::diffuse &&
                   library_.name(other.image) == library_.name(wish.image);
        });
        map.texture = library_.texture(same != wishes_.end() ? same->image : wish.image);
    } else {
        map = numbers(wish);
    }
    choose_alpha_mode(material, image, map.channel);
    if (wish.map.kind == MtlMapKind::transparency) {
        map.base = 1.0f - map.base;
        map.gain = -map.gain;
    }
    material.map(MapSlot::opacity) = map;
}

// MTL doesn't say so, but a picture of a leaf with alpha is a leaf.
void MtlTextures::cut_out_by_alpha(const Wish& wish, Material& material) {
    if (wish.map.kind != MtlMapKind::diffuse || material.map(MapSlot::opacity) ||
        library_.broken(wish.image)) {
        return;
    }
    const ByteImage& image = *library_.pixels(wish.image);
    if (is_uniform(image, 3)) return;
    TextureMap map = material.map(MapSlot::diffuse);
    map.channel = 3;
    map.base = 0.0f;
    map.gain = 1.0f;
    material.map(MapSlot::opacity) = map;
    choose_alpha_mode(material, image, 3);
}

ByteImage normals_of_heights(const ByteImage& heights, double scale) {
    ByteImage normals{heights.rows, heights.cols, {}};
    normals.texels.reserve(heights.texels.size());
    const auto height = [&](int row, int col) {
        const auto r = static_cast<std::size_t>((row + heights.rows) % heights.rows);
        const auto c = static_cast<std::size_t>((col + heights.cols) % heights.cols);
        const glm::u8vec4& texel = heights.texels[r * static_cast<std::size_t>(heights.cols) + c];
        return (0.2126 * texel.x + 0.7152 * texel.y + 0.0722 * texel.z) / 255.0;
    };
    const auto byte = [](double x) {
        return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * x));
    };
    for (int row = 0; row < heights.rows; ++row) {
        for (int col = 0; col < heights.cols; ++col) {
            const double along_u = 0.5 * (height(row, col + 1) - height(row, col - 1));
            // Rows go down, v goes up.
            const double along_v = 0.5 * (height(row - 1, col) - height(row + 1, col));
            const glm::dvec3 n =
                glm::normalize(glm::dvec3(-scale * along_u, -scale * along_v, 1.0));
            normals.texels.emplace_back(byte(n.x), byte(n.y), byte(n.z), 255);
        }
    }
    return normals;
}

bool looks_like_normals(const ByteImage& image) {
    glm::dvec3 sum(0.0);
    for (const glm::u8vec4& c : image.texels)
        sum += glm::dvec3(c.x, c.y, c.z);
    const glm::dvec3 mean = sum / (255.0 * static_cast<double>(image.texels.size()));
    return std::abs(mean.x - 0.5) < 0.1 && std::abs(mean.y - 0.5) < 0.1 && mean.z > 0.75;
}

}  // namespace raypick
