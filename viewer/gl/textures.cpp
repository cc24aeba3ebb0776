#include "viewer/gl/textures.h"

#include "tracer/error.h"
#include "viewer/gl/load_gl.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace raypick {

GlTexture make_texture(TexelFormat format, ImageSize size, const void* texels) {
    GlTexture texture = new_texture();
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.internal), size.cols, size.rows, 0,
                 format.format, format.type, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return texture;
}

Framebuffer make_framebuffer(std::span<const GLuint> colours, GLuint depth_stencil) {
    Framebuffer framebuffer = new_framebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    std::vector<GLenum> targets;
    for (const GLuint texture : colours) {
        targets.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size()));
        glFramebufferTexture2D(GL_FRAMEBUFFER, targets.back(), GL_TEXTURE_2D, texture, 0);
    }
    glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
    if (targets.empty()) glReadBuffer(GL_NONE);
    if (depth_stencil != 0) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D,
                               depth_stencil, 0);
    }
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(fmt::format("this OpenGL cannot draw to the buffers we need (status 0x{:04x})",
                                status));
    }
    return framebuffer;
}

BufferTexture::BufferTexture(GLenum internal_format, std::size_t texel_bytes, std::size_t texels,
                             const char* what)
    : buffer_(new_buffer()),
      texture_(new_texture()),
      // Never empty: a buffer texture over no storage reads undefined values.
      bytes_(texel_bytes * std::max<std::size_t>(texels, 1)) {
    if (texels > max_buffer_texels()) {
        throw Error(fmt::format("{} {} are more than this OpenGL can hold ({})", texels, what,
                                max_buffer_texels()));
    }
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_.name());
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes_), nullptr, GL_STATIC_DRAW);
    glBindTexture(GL_TEXTURE_BUFFER, texture_.name());
    glTexBuffer(GL_TEXTURE_BUFFER, internal_format, buffer_.name());
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

BufferTexture::BufferTexture(GLenum internal_format, std::size_t texel_bytes,
                             std::span<const std::byte> bytes, const char* what)
    : BufferTexture(internal_format, texel_bytes, bytes.size() / texel_bytes, what) {
    if (bytes.empty()) return;
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_.name());
    glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

std::byte* BufferTexture::map() {
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_.name());
    void* const memory = glMapBufferRange(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes_),
                                          GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
    if (memory == nullptr) {
        check_gl("uploading the scene");
        throw Error("uploading the scene: OpenGL gives no memory");
    }
    return static_cast<std::byte*>(memory);
}

void BufferTexture::unmap() {
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_.name());
    const bool kept = glUnmapBuffer(GL_TEXTURE_BUFFER) == GL_TRUE;
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
    if (!kept) throw Error("uploading the scene: OpenGL has lost what it was given");
}

KeepFramebuffer::KeepFramebuffer() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
}

KeepFramebuffer::~KeepFramebuffer() {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
}

}  // namespace raypick
