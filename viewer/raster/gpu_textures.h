// The scene's textures on the GPU: every mip chain in one buffer, so that shaders read the very
// texels that the tracer reads and filter them with the same formulas.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/gl/textures.h"

#include <memory>
#include <string>
#include <vector>

namespace raypick {

// Read by shaders/texture.glsl.
struct GpuTextures {
    BufferTexture texels;  // RGBA8, as stored; row 0 of a level on top
    // Unsigned numbers, four a texel. Three texels for each texture of the scene:
    //   image:   (0, TexelCoding, levels, index of the first level's texel)
    //   checker: (1, 0, 0, 0), then the bits of `even`, then those of `odd`
    // and behind these one for each level: (cols, rows, first texel, 0).
    BufferTexture table;
    std::vector<Texture> sources;  // what was uploaded
    std::string warning;           // if finest levels had to be left out; else ""
};

// `before` is given back if it holds the same textures. Images that are more than this OpenGL's
// buffers hold lose their finest levels, the largest first.
std::shared_ptr<const GpuTextures> upload_textures(
    const Scene& scene, const std::shared_ptr<const GpuTextures>& before);

// The same with a limit of the caller's.
GpuTextures pack_textures(const std::vector<Texture>& textures, std::size_t max_texels);

}  // namespace raypick
