// Owners of OpenGL names.
#pragma once

#include <glad/gl.h>

#include <utility>

namespace raypick {

// Owns one OpenGL name and deletes it with Kind::destroy. 0 owns nothing. Moving is a swap, so that
// moving onto oneself is harmless. Must be destroyed while its context is current.
template <typename Kind>
class GlHandle {
public:
    GlHandle() = default;
    explicit GlHandle(GLuint name) : name_(name) {}
    ~GlHandle() {
        if (name_ != 0) Kind::destroy(name_);
    }
    GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlHandle& operator=(GlHandle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlHandle(const GlHandle&) = delete;
    GlHandle& operator=(const GlHandle&) = delete;

    [[nodiscard]] GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

private:
    GLuint name_ = 0;
};

struct BufferKind {
    static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureKind {
    static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct RenderbufferKind {
    static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct FramebufferKind {
    static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct VertexArrayKind {
    static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct ShaderKind {
    static void destroy(GLuint name) { glDeleteShader(name); }
};
struct ProgramKind {
    static void destroy(GLuint name) { glDeleteProgram(name); }
};

using Buffer = GlHandle<BufferKind>;
using GlTexture = GlHandle<TextureKind>;
using Renderbuffer = GlHandle<RenderbufferKind>;
using Framebuffer = GlHandle<FramebufferKind>;
using VertexArray = GlHandle<VertexArrayKind>;
using Shader = GlHandle<ShaderKind>;
using Program = GlHandle<ProgramKind>;

// New names, nothing allocated behind them yet.
inline Buffer new_buffer() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return Buffer(name);
}
inline GlTexture new_texture() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return GlTexture(name);
}
inline Renderbuffer new_renderbuffer() {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    return Renderbuffer(name);
}
inline Framebuffer new_framebuffer() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return Framebuffer(name);
}
inline VertexArray new_vertex_array() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return VertexArray(name);
}

}  // namespace raypick
