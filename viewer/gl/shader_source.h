// GLSL sources: files of shaders/, compiled into the binary.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

struct EmbeddedShader {
    std::string_view name;  // file name in shaders/, e.g. "local_light.glsl"
    std::string_view text;
};

// All files of shaders/ as they were when the program was built (generated at build time).
std::span<const EmbeddedShader> embedded_shaders();

// The folder named by RAYPICK_SHADER_DIR, from which shaders are then read instead.
std::optional<std::filesystem::path> shader_folder();

// A shader put together for the compiler.
struct ShaderSource {
    std::string text;
    std::vector<std::string> files;  // by GLSL's source string number, as in error messages
};

// The text of a shader file after "#version 330 core" and a #define for each of `defines`
// ("NAME" or "NAME VALUE"), with every line `#include "other"` replaced by that file (each once).
// Throws Error that names a missing file.
ShaderSource shader_source(std::string_view name, std::span<const std::string> defines = {});

}  // namespace raypick
