#include "viewer/gl/textures.h"

#include "tracer/error.h"
#include "viewer/gl/load_gl.h"

#include <fmt/format.h>

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

BufferTexture::BufferTexture(GLenum internal_format, std::size_t texel_bytes,
                             std::span<const std::byte> bytes, const char* what)
    : buffer_(new_buffer()), texture_(new_texture()) {
    const std::size_t texels = bytes.size() / texel_bytes;
    if (texels > max_buffer_texels()) {
        throw Error(fmt::format("{} {} are more than this OpenGL can hold ({})", texels, what,
                                max_buffer_texels()));
    }
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_.name());
    // Never empty: a buffer texture over no storage reads undefined values.
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(std::max(bytes.size(), texel_bytes)),
                 nullptr, GL_STATIC_DRAW);
    if (!bytes.empty()) {
        glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    }
    glBindTexture(GL_TEXTURE_BUFFER, texture_.name());
    glTexBuffer(GL_TEXTURE_BUFFER, internal_format, buffer_.name());
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
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
