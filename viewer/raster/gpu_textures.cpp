#include "viewer/raster/gpu_textures.h"

#include "tracer/parallel/parallel.h"
#include "viewer/gl/load_gl.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstring>

namespace raypick {

namespace {

using Pixels = std::shared_ptr<const TexturePixels>;

// An image on its way to the GPU, without its `left_out` finest levels.
struct PackedImage {
    Pixels pixels;
    std::size_t left_out = 0;
    std::size_t first_level = 0;  // in the table

    [[nodiscard]] std::size_t first_texel() const { return pixels->levels[left_out].first; }
    [[nodiscard]] std::size_t texel_count() const { return pixels->texels.size() - first_texel(); }
    [[nodiscard]] std::size_t level_count() const { return pixels->levels.size() - left_out; }
};

// Each image once, however many textures use it.
std::vector<PackedImage> distinct_images(const std::vector<Texture>& textures) {
    std::vector<PackedImage> images;
    for (const Texture& texture : textures) {
        const auto* image = std::get_if<ImageTexture>(&texture.source);
        if (image == nullptr) continue;
        const bool known = std::any_of(images.begin(), images.end(), [image](const auto& other) {
            return other.pixels == image->pixels;
        });
        if (!known) images.push_back({image->pixels});
    }
    return images;
}

std::size_t total_texels(const std::vector<PackedImage>& images) {
    std::size_t total = 0;
    for (const PackedImage& image : images)
        total += image.texel_count();
    return total;
}

// Leaves out finest levels, the largest first. Returns how many.
int make_fit(std::vector<PackedImage>& images, std::size_t max_texels) {
    int left_out = 0;
    const auto shrinkable_texels = [](const PackedImage& image) {
        return image.level_count() > 1 ? image.texel_count() : 0;
    };
    while (total_texels(images) > max_texels) {
        const auto largest = std::max_element(
            images.begin(), images.end(), [&](const PackedImage& a, const PackedImage& b) {
                return shrinkable_texels(a) < shrinkable_texels(b);
            });
        if (shrinkable_texels(*largest) == 0) break;  // BufferTexture refuses the rest
        ++largest->left_out;
        ++left_out;
    }
    return left_out;
}

// One image's behind the other's.
BufferTexture join_texels(const std::vector<PackedImage>& images) {
    BufferTexture joined(GL_RGBA8, sizeof(glm::u8vec4), total_texels(images), "texels");
    if (images.empty()) return joined;
    std::vector<std::byte*> places{joined.map()};
    for (const PackedImage& image : images)
        places.push_back(places.back() + sizeof(glm::u8vec4) * image.texel_count());
    parallel_for(images.size(), 0, {}, [&](std::size_t i) {
        const PackedImage& image = images[i];
        std::memcpy(places[i], image.pixels->texels.data() + image.first_texel(),
                    sizeof(glm::u8vec4) * image.texel_count());
    });
    joined.unmap();
    return joined;
}

glm::uvec4 bits(const glm::vec4& v) {
    glm::uvec4 result;
    static_assert(sizeof(result) == sizeof(v));
    std::memcpy(&result, &v, sizeof(v));
    return result;
}

// The three texels of one texture.
struct TableEntry {
    const std::vector<PackedImage>& images;
    std::vector<glm::uvec4>& table;

    void operator()(const ImageTexture& texture) const {
        const auto image = std::find_if(images.begin(), images.end(), [&](const auto& other) {
            return other.pixels == texture.pixels;
        });
        table.emplace_back(0, static_cast<glm::uint>(image->pixels->coding), image->level_count(),
                           image->first_level);
        table.resize(table.size() + 2);
    }
    void operator()(const Checker& checker) const {
        table.emplace_back(1, 0, 0, 0);
        table.push_back(bits(checker.even));
        table.push_back(bits(checker.odd));
    }
};

std::vector<glm::uvec4> make_table(const std::vector<Texture>& textures,
                                   std::vector<PackedImage>& images) {
    std::size_t next_level = 3 * textures.size();
    for (PackedImage& image : images) {
        image.first_level = next_level;
        next_level += image.level_count();
    }
    std::vector<glm::uvec4> table;
    table.reserve(next_level);
    for (const Texture& texture : textures)
        std::visit(TableEntry{images, table}, texture.source);
    std::size_t base = 0;
    for (const PackedImage& image : images) {
        for (std::size_t i = image.left_out; i < image.pixels->levels.size(); ++i) {
            const TextureLevel& level = image.pixels->levels[i];
            table.emplace_back(level.cols, level.rows, base + level.first - image.first_texel(), 0);
        }
        base += image.texel_count();
    }
    return table;
}

bool same_source(const Texture& a, const Texture& b) {
    if (a.source.index() != b.source.index()) return false;
    if (const auto* image = std::get_if<ImageTexture>(&a.source)) {
        return image->pixels == std::get<ImageTexture>(b.source).pixels;
    }
    const auto& checker = std::get<Checker>(a.source);
    const auto& other = std::get<Checker>(b.source);
    return checker.even == other.even && checker.odd == other.odd;
}

}  // namespace

GpuTextures pack_textures(const std::vector<Texture>& textures, std::size_t max_texels) {
    std::vector<PackedImage> images = distinct_images(textures);
    GpuTextures gpu;
    if (const int left_out = make_fit(images, max_texels); left_out > 0) {
        gpu.warning = fmt::format(
            "the textures are more than this OpenGL can hold ({} texels): the raster view shows "
            "them without their {} finest levels",
            max_texels, left_out);
    }
    const std::vector<glm::uvec4> table = make_table(textures, images);
    gpu.texels = join_texels(images);
    gpu.table = {GL_RGBA32UI, sizeof(glm::uvec4), std::as_bytes(std::span(table)),
                 "texture levels"};
    return gpu;
}

std::shared_ptr<const GpuTextures> upload_textures(
    const Scene& scene, const std::shared_ptr<const GpuTextures>& before) {
    if (before != nullptr &&
        std::equal(before->sources.begin(), before->sources.end(), scene.textures.begin(),
                   scene.textures.end(), same_source)) {
        return before;
    }
    auto gpu = std::make_shared<GpuTextures>(pack_textures(scene.textures, max_buffer_texels()));
    gpu->sources = scene.textures;
    return gpu;
}

}  // namespace raypick
