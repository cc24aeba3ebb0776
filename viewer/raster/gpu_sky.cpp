#include "viewer/raster/gpu_sky.h"

#include "viewer/gl/load_gl.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace raypick {

namespace {

std::vector<const SkyPixels*> levels_of(const SkyPixels& pixels) {
    std::vector<const SkyPixels*> levels{&pixels};
    for (const SkyPixels& level : pixels.smaller)
        levels.push_back(&level);
    return levels;
}

std::size_t texel_count(const std::vector<const SkyPixels*>& levels) {
    std::size_t count = 0;
    for (const SkyPixels* level : levels)
        count += level->texels.size();
    return count;
}

// Texels of three floats came with OpenGL 4.0 only.
std::vector<glm::vec4> padded(const std::vector<const SkyPixels*>& levels) {
    std::vector<glm::vec4> texels;
    texels.reserve(texel_count(levels));
    for (const SkyPixels* level : levels) {
        for (const glm::vec3& texel : level->texels)
            texels.emplace_back(texel, 0.0f);
    }
    return texels;
}

BufferTexture upload(const std::vector<glm::vec4>& texels) {
    return {GL_RGBA32F, sizeof(glm::vec4), std::as_bytes(std::span(texels)), "sky texels"};
}

GpuSky upload_pixels(std::shared_ptr<const SkyPixels> pixels) {
    GpuSky gpu;
    std::vector<const SkyPixels*> levels = levels_of(*pixels);
    while (levels.size() > 1 && texel_count(levels) > max_buffer_texels()) {
        levels.erase(levels.begin());
        gpu.warning = fmt::format(
            "the sky's image is more than this OpenGL can hold ({} texels): the raster view shows "
            "it with {} x {}",
            max_buffer_texels(), levels.front()->cols, levels.front()->rows);
    }
    gpu.texels = upload(padded(levels));
    gpu.size = {levels.front()->cols, levels.front()->rows};
    gpu.levels = static_cast<int>(levels.size());
    gpu.pixels = std::move(pixels);
    return gpu;
}

// What depends on the kind of environment.
struct SkyUniforms {
    const Uniforms& uniforms;
    const GpuSky& gpu;

    void operator()(std::monostate) const {}
    void operator()(const GradientSky& sky) const {
        uniforms.set("zenith", sky.zenith);
        uniforms.set("horizon", sky.horizon);
        uniforms.set("ground", sky.ground);
        uniforms.set("sky_up", glm::vec3(glm::normalize(sky.up)));
    }
    void operator()(const ImageSky& sky) const {
        const glm::dvec3 up = glm::normalize(sky.up);
        const glm::dvec3 right = glm::normalize(glm::cross(sky.forward, up));
        uniforms.set("sky_up", glm::vec3(up));
        uniforms.set("sky_right", glm::vec3(right));
        uniforms.set("sky_forward", glm::vec3(glm::cross(up, right)));
        uniforms.set("sky_scale", sky.scale);
        uniforms.set("sky_size", gpu.size);
        uniforms.set("sky_levels", gpu.levels);
    }
};

}  // namespace

std::shared_ptr<const GpuSky> upload_sky(const Environment& environment,
                                         const std::shared_ptr<const GpuSky>& before) {
    const auto* sky = std::get_if<ImageSky>(&environment);
    const std::shared_ptr<const SkyPixels> pixels = sky != nullptr ? sky->pixels : nullptr;
    if (before != nullptr && before->pixels == pixels) return before;
    if (pixels != nullptr) return std::make_shared<GpuSky>(upload_pixels(pixels));
    GpuSky none;
    none.texels = upload({});
    return std::make_shared<GpuSky>(std::move(none));
}

void set_sky(const Uniforms& uniforms, const Scene& scene, const GpuSky& sky) {
    uniforms.set("sky_kind", static_cast<int>(scene.environment.index()));
    uniforms.set("background", scene.background);
    std::visit(SkyUniforms{uniforms, sky}, scene.environment);
}

}  // namespace raypick
