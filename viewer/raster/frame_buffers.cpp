#include "viewer/raster/frame_buffers.h"

#include "tracer/error.h"
#include "viewer/gl/load_gl.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace raypick {

namespace {

void check_size(ImageSize size) {
    if (size.rows <= 0 || size.cols <= 0) throw Error("the image is empty");
    GLint texture = 0;
    GLint viewport[2] = {};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    const int cols = std::min(texture, viewport[0]);
    const int rows = std::min(texture, viewport[1]);
    if (size.cols > cols || size.rows > rows) {
        throw Error(fmt::format("{} x {} pixels are more than this OpenGL can draw ({} x {})",
                                size.cols, size.rows, cols, rows));
    }
}

}  // namespace

FrameBuffers::FrameBuffers(ImageSize image_size, bool with_textures) : size(image_size) {
    check_size(size);
    normal_t = make_texture(kRgba32f, size);
    object = make_texture(kR32ui, size);
    primitive = make_texture(kR32ui, size);
    material = make_texture(kR32ui, size);
    depth_stencil = make_texture(kDepth32fStencil8, size);
    colour_t = make_texture(kRgba32f, size);
    check_gl("making the frame's buffers");
    depth = make_framebuffer({}, depth_stencil.name());
    const GLuint colours[] = {colour_t.name()};
    colour = make_framebuffer(colours, depth_stencil.name());
    if (with_textures) {
        add_texture_targets();
    } else {
        surface = surface_framebuffer();
    }
}

void FrameBuffers::add_texture_targets() {
    textured = true;
    uv = make_texture(kRg32f, size);
    footprint = make_texture(kRgba32f, size);
    check_gl("making the frame's buffers");
    surface = surface_framebuffer();
}

Framebuffer FrameBuffers::surface_framebuffer() const {
    std::vector<GLuint> targets{normal_t.name(), object.name(), primitive.name(), material.name()};
    if (textured) targets.insert(targets.end(), {uv.name(), footprint.name()});
    return make_framebuffer(targets, depth_stencil.name());
}

void FrameBuffers::clear() const {
    glBindFramebuffer(GL_FRAMEBUFFER, surface.name());
    const float miss[] = {0.0f, 0.0f, 0.0f, std::numeric_limits<float>::infinity()};
    const GLuint none[] = {0xffffffffu, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, miss);
    for (GLint target = 1; target <= 3; ++target)
        glClearBufferuiv(GL_COLOR, target, none);
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 1.0f, 0);
}

}  // namespace raypick
