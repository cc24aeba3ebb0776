// Shader programs.
#pragma once

#include "viewer/gl/gl_handle.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace raypick {

// Compiles and links two files of shaders/, both with the same `defines`. Throws Error with the
// compiler's message, in which source string numbers are replaced by file names.
Program make_program(std::string_view vertex_file, std::string_view fragment_file,
                     std::span<const std::string> defines = {});

// Sets uniforms of one program by name; names that the compiler optimised away are ignored.
class Uniforms {
public:
    // Makes the program current.
    explicit Uniforms(const Program& program);

    void set(const char* name, int value) const;
    void set(const char* name, std::uint32_t value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const glm::vec2& value) const;
    void set(const char* name, const glm::ivec2& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::mat3& value) const;

private:
    GLuint program_;
};

// Binds `texture` to `unit` for `target` and nothing else.
void bind_texture(GLuint unit, GLenum target, GLuint texture);

}  // namespace raypick
