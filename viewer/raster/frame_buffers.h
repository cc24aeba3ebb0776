// The textures that a frame is drawn to.
#pragma once

#include "tracer/geometry/pixel.h"
#include "viewer/gl/textures.h"

namespace raypick {

// Bottom row first. Cleared to background by clear().
struct FrameBuffers {
    FrameBuffers() = default;
    // With `with_textures`, also what texture look-ups need. Throws Error if OpenGL can't draw
    // images of this size.
    FrameBuffers(ImageSize image_size, bool with_textures);

    // What a frame without them lacks to be `textured`.
    void add_texture_targets();
    // Makes every pixel background, ready for the passes. Leaves `surface` bound.
    void clear() const;

    ImageSize size;
    bool textured = false;
    GlTexture normal_t;   // normal towards the eye, 0 on background; t
    GlTexture object;     // id
    GlTexture primitive;  // 0xffffffff on background
    GlTexture material;
    // Of a textured frame, undefined where the material isn't textured: the surface's uv, and what
    // the pixel covers of it (Footprint: major, minor).
    GlTexture uv;
    GlTexture footprint;
    GlTexture depth_stencil;
    GlTexture colour_t;   // linear RGB; t
    Framebuffer depth;    // first pass: depth alone
    Framebuffer surface;  // second pass: all of the above but colour
    Framebuffer colour;   // third pass, by the stencil of the second

private:
    [[nodiscard]] Framebuffer surface_framebuffer() const;
};

}  // namespace raypick
