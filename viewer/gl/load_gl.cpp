#include "viewer/gl/load_gl.h"

#include "tracer/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace raypick {

namespace {

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? "?" : reinterpret_cast<const char*>(text);
}

}  // namespace

void load_gl(GLADloadfunc get_proc_address) {
    const int version = gladLoadGL(get_proc_address);
    if (version == 0) throw Error("no OpenGL functions could be loaded");
    if (version < GLAD_MAKE_VERSION(3, 3)) {
        throw Error(fmt::format("OpenGL 3.3 is needed; this context has {}.{} ({})",
                                GLAD_VERSION_MAJOR(version), GLAD_VERSION_MINOR(version),
                                gl_string(GL_RENDERER)));
    }
}

std::string gl_description() {
    return fmt::format("{}, OpenGL {}", gl_string(GL_RENDERER), gl_string(GL_VERSION));
}

bool draws_in_software() {
    const std::string renderer = gl_string(GL_RENDERER);
    const auto names = {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"};
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

std::size_t max_buffer_texels() {
    GLint texels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    return static_cast<std::size_t>(texels);
}

void check_gl(const std::string& doing) {
    const GLenum first = glGetError();
    if (first == GL_NO_ERROR) return;
    // More flags may be set; a lost context reports for ever, hence the bound.
    for (int more = 0; more < 8 && glGetError() != GL_NO_ERROR; ++more) {
    }
    if (first == GL_OUT_OF_MEMORY) throw Error(doing + ": the graphics memory is full");
    throw Error(fmt::format("{}: OpenGL error 0x{:04x}", doing, first));
}

}  // namespace raypick
