// The rasteriser's shader programs.
#pragma once

#include "viewer/gl/program.h"
#include "viewer/raster/gpu_materials.h"

#include <array>
#include <filesystem>
#include <optional>

namespace raypick {

// In the order of DrawnShape's alternatives.
inline constexpr std::size_t kShapeKinds = 10;

// Which pass a shape's program is for.
enum class Pass : std::size_t { depth, surface };

// What the third pass's program must know.
struct ShadeKind {
    bool textured = false;       // the frame has texture coordinates
    bool image_sky = false;      // the surroundings are an image
    bool shaped_lights = false;  // some light is neither a point nor directional
};

// Programs of the first two passes are compiled when they are first asked for: scenes need few.
class ShaderSet {
public:
    // Throws Error with the compiler's message, as shape() does.
    ShaderSet();

    // `kind` is the index of the DrawnShape.
    const Program& shape(Pass pass, std::size_t kind, const SurfaceLook& look);
    const Program& shade(const ShadeKind& kind);

    // The same programs, compiled again.
    [[nodiscard]] ShaderSet again() const;

private:
    static constexpr std::size_t kVariants = 16;  // two passes, a bit for each of a look's flags

    std::array<std::array<Program, kVariants>, kShapeKinds> shapes_;  // 0: not asked for yet
    std::array<Program, 8> shade_;                                    // a bit for each flag
};

// Texture units and uniform buffer binding points of these programs.
enum class Unit : GLuint {
    triangles,
    positions,
    normals,
    uvs,
    normal_t,
    material,
    materials,
    lights,
    maps,
    texture_table,
    texels,
    uv,
    footprint,
    sky_texels
};
inline constexpr GLuint kViewBinding = 0;

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
