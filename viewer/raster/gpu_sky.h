// The scene's environment on the GPU.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/gl/program.h"
#include "viewer/gl/textures.h"

#include <memory>
#include <string>

namespace raypick {

// An image sky with its mip chain, the finest level first, a texel each: RGB and nothing.
struct GpuSky {
    BufferTexture texels;
    glm::ivec2 size{0};  // columns and rows of the finest level
    int levels = 0;
    std::shared_ptr<const SkyPixels> pixels;  // what was uploaded; null: no image
    std::string warning;                      // if finest levels had to be left out; else ""
};

// `before` is given back if it holds the same image. An image of more texels than this OpenGL's
// buffers hold loses its finest levels.
std::shared_ptr<const GpuSky> upload_sky(const Environment& environment,
                                         const std::shared_ptr<const GpuSky>& before);

// Sets what shaders/environment.glsl reads, but for its texture unit.
void set_sky(const Uniforms& uniforms, const Scene& scene, const GpuSky& sky);

}  // namespace raypick
