// Textures and the framebuffers over them.
#pragma once

#include "tracer/geometry/pixel.h"
#include "viewer/gl/gl_handle.h"

#include <span>

namespace raypick {

// How a texture's texels look to OpenGL.
struct TexelFormat {
    GLenum internal;  // GL_RGBA32F
    GLenum format;    // GL_RGBA
    GLenum type;      // GL_FLOAT
};
inline constexpr TexelFormat kRgba32f{GL_RGBA32F, GL_RGBA, GL_FLOAT};
inline constexpr TexelFormat kRg32f{GL_RG32F, GL_RG, GL_FLOAT};
inline constexpr TexelFormat kRgb32f{GL_RGB32F, GL_RGB, GL_FLOAT};
inline constexpr TexelFormat kR32ui{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
inline constexpr TexelFormat kDepth32fStencil8{GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL,
                                               GL_FLOAT_32_UNSIGNED_INT_24_8_REV};

// An unfiltered 2D texture without mipmaps, bottom row first; `texels` may be null.
GlTexture make_texture(TexelFormat format, ImageSize size, const void* texels = nullptr);

// A framebuffer that draws to `colours` (in this order) and, unless 0, to a depth and stencil
// texture. Throws Error if OpenGL refuses the combination. Leaves it bound.
Framebuffer make_framebuffer(std::span<const GLuint> colours, GLuint depth_stencil = 0);

// A one-dimensional array for shaders: a buffer and the buffer texture that reads it.
class BufferTexture {
public:
    BufferTexture() = default;
    // Throws Error if there are more texels than this OpenGL allows. `what` is for that message.
    BufferTexture(GLenum internal_format, std::size_t texel_bytes, std::span<const std::byte> bytes,
                  const char* what);

    // With room for `texels`, whose content is what is written while it is mapped.
    BufferTexture(GLenum internal_format, std::size_t texel_bytes, std::size_t texels,
                  const char* what);

    // All of it, to be written by any thread, and each byte before unmap(). Throws Error if OpenGL
    // has no memory.
    [[nodiscard]] std::byte* map();
    // Throws Error if OpenGL has lost what was written.
    void unmap();

    [[nodiscard]] GLuint texture() const { return texture_.name(); }
    [[nodiscard]] GLuint buffer() const { return buffer_.name(); }

private:
    Buffer buffer_;
    GlTexture texture_;
    std::size_t bytes_ = 0;
};

// Restores the framebuffer bindings that were there before.
class KeepFramebuffer {
public:
    KeepFramebuffer();
    ~KeepFramebuffer();
    KeepFramebuffer(const KeepFramebuffer&) = delete;
    KeepFramebuffer& operator=(const KeepFramebuffer&) = delete;

private:
    GLint draw_ = 0;
    GLint read_ = 0;
};

}  // namespace raypick
