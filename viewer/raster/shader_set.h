// The rasteriser's shader programs.
#pragma once

#include "viewer/gl/program.h"

#include <array>
#include <filesystem>
#include <optional>

namespace raypick {

// In the order of DrawnShape's alternatives.
inline constexpr std::size_t kShapeKinds = 4;

struct ShaderSet {
    std::array<Program, kShapeKinds> depth;    // first pass
    std::array<Program, kShapeKinds> surface;  // second pass
    Program shade;                             // third pass
};

// Texture units and uniform buffer binding points of these programs.
enum class Unit : GLuint { triangles, positions, normals, normal_t, material, materials, lights };
inline constexpr GLuint kViewBinding = 0;

// Throws Error with the compiler's message.
ShaderSet make_shader_set();

// Sees when files of the folder in RAYPICK_SHADER_DIR change.
class ShaderWatch {
public:
    ShaderWatch();
    // True once after each change.
    bool changed();

private:
    [[nodiscard]] std::filesystem::file_time_type newest() const;

    std::optional<std::filesystem::path> folder_;
    std::filesystem::file_time_type seen_;
};

}  // namespace raypick
