// The textures that a frame is drawn to.
#pragma once

#include "tracer/geometry/pixel.h"
#include "viewer/gl/textures.h"

namespace raypick {

// Bottom row first. Cleared to background by clear().
struct FrameBuffers {
    FrameBuffers() = default;
    // Throws Error if OpenGL can't draw images of this size.
    explicit FrameBuffers(ImageSize image_size);

    // Makes every pixel background, ready for the passes. Leaves `surface` bound.
    void clear() const;

    ImageSize size;
    Texture normal_t;   // normal towards the eye, 0 on background; t
    Texture object;     // id
    Texture primitive;  // 0xffffffff on background
    Texture material;
    Texture depth_stencil;
    Texture colour_t;     // linear RGB; t
    Framebuffer depth;    // first pass: depth alone
    Framebuffer surface;  // second pass: all of the above but colour
    Framebuffer colour;   // third pass
};

}  // namespace raypick
