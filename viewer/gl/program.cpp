#include "viewer/gl/program.h"

#include "tracer/error.h"
#include "viewer/gl/shader_source.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <vector>

namespace raypick {

namespace {

// A number at the beginning of `text`, which is then cut off; nothing if there is none.
std::optional<std::size_t> take_number(std::string_view& text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

// "0:12(3): error" (Mesa) and "0(12) : error" (NVIDIA) become "surface.frag:12...". Other lines
// stay as they are.
std::string with_file_name(std::string_view line, const std::vector<std::string>& files) {
    std::string_view rest = line;
    const auto file = take_number(rest);
    if (!file || *file >= files.size() || rest.empty()) return std::string(line);
    const bool in_brackets = rest.front() == '(';
    if (!in_brackets && rest.front() != ':') return std::string(line);
    rest.remove_prefix(1);
    const auto number = take_number(rest);
    if (!number) return std::string(line);
    if (in_brackets && !rest.empty()) rest.remove_prefix(1);
    return fmt::format("{}:{}{}", files[*file], *number, rest);
}

std::string with_file_names(const std::string& log, const std::vector<std::string>& files) {
    std::istringstream lines(log);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        result += with_file_name(line, files) + "\n";
    }
    return result;
}

Shader compile(GLenum type, std::string_view file, std::span<const std::string> defines) {
    const ShaderSource source = shader_source(file, defines);
    Shader shader(glCreateShader(type));
    const char* text = source.text.c_str();
    glShaderSource(shader.name(), 1, &text, nullptr);
    glCompileShader(shader.name());
    GLint ok = 0;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &ok);
    if (ok != 0) return shader;
    GLint length = 0;
    glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader.name(), length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw Error(
        fmt::format("shader {} does not compile:\n{}", file, with_file_names(log, source.files)));
}

}  // namespace

Program make_program(std::string_view vertex_file, std::string_view fragment_file,
                     std::span<const std::string> defines) {
    const Shader vertex = compile(GL_VERTEX_SHADER, vertex_file, defines);
    const Shader fragment = compile(GL_FRAGMENT_SHADER, fragment_file, defines);
    Program program(glCreateProgram());
    glAttachShader(program.name(), vertex.name());
    glAttachShader(program.name(), fragment.name());
    glLinkProgram(program.name());
    glDetachShader(program.name(), vertex.name());
    glDetachShader(program.name(), fragment.name());
    GLint ok = 0;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &ok);
    if (ok != 0) return program;
    GLint length = 0;
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program.name(), length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw Error(fmt::format("shaders {} and {} do not link:\n{}", vertex_file, fragment_file, log));
}

Uniforms::Uniforms(const Program& program) : program_(program.name()) {
    glUseProgram(program_);
}

void Uniforms::set(const char* name, int value) const {
    glUniform1i(glGetUniformLocation(program_, name), value);
}
void Uniforms::set(const char* name, std::uint32_t value) const {
    glUniform1ui(glGetUniformLocation(program_, name), value);
}
void Uniforms::set(const char* name, float value) const {
    glUniform1f(glGetUniformLocation(program_, name), value);
}
void Uniforms::set(const char* name, const glm::vec2& value) const {
    glUniform2f(glGetUniformLocation(program_, name), value.x, value.y);
}
void Uniforms::set(const char* name, const glm::ivec2& value) const {
    glUniform2i(glGetUniformLocation(program_, name), value.x, value.y);
}
void Uniforms::set(const char* name, const glm::vec3& value) const {
    glUniform3f(glGetUniformLocation(program_, name), value.x, value.y, value.z);
}
void Uniforms::set(const char* name, const glm::mat3& value) const {
    glUniformMatrix3fv(glGetUniformLocation(program_, name), 1, GL_FALSE, glm::value_ptr(value));
}

void bind_texture(GLuint unit, GLenum target, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, texture);
}

}  // namespace raypick
