// Images and patterns that vary a material over a surface. Texture coordinates run from (0, 0) at
// the bottom left corner of an image to (1, 1) at its top right one.
//
// The GLSL twin of sample() is in shaders/texture.glsl.
#pragma once

#include "tracer/scene/texel_coding.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace raypick {

using TextureId = std::uint32_t;
inline constexpr TextureId kNoTexture = 0xffffffffu;

// One image of a mip chain: texels [first, first + rows * cols), row 0 on top.
struct TextureLevel {
    int rows = 0;
    int cols = 0;
    std::size_t first = 0;
};

// An image with its mip chain, each level half the one before, rounded down, at least 1.
struct TexturePixels {
    TexelCoding coding = TexelCoding::srgb;
    std::vector<TextureLevel> levels;
    std::vector<glm::u8vec4> texels;  // alpha is always linear
};

// Builds the mip chain of an image, averaging linear values. Throws Error if the size doesn't fit.
std::shared_ptr<const TexturePixels> make_texture_pixels(int rows, int cols,
                                                         std::vector<glm::u8vec4> texels,
                                                         TexelCoding coding);

struct ImageTexture {
    std::shared_ptr<const TexturePixels> pixels;
    std::filesystem::path file;  // where it came from; "" if it was inside another file
};

// Squares of side 1 in texture coordinates; `even` where floor(u) + floor(v) is even.
struct Checker {
    glm::vec4 even{1.0f};
    glm::vec4 odd{0.0f, 0.0f, 0.0f, 1.0f};
};

struct Texture {
    std::string name;
    std::variant<ImageTexture, Checker> source;
};

enum class Wrap { repeat, clamp, mirror };
enum class TextureFilter { nearest, linear };  // linear: trilinear and anisotropic

// A use of scene.textures[texture] by a material: value = base + gain * texel.
struct TextureMap {
    TextureId texture = kNoTexture;
    glm::vec3 u_row{1.0f, 0.0f, 0.0f};  // texture u = dot(u_row, (u, v, 1)) of the surface's uv
    glm::vec3 v_row{0.0f, 1.0f, 0.0f};
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    int channel = 0;  // 0..3: which one maps of a single number take
    float base = 0.0f;
    float gain = 1.0f;

    explicit operator bool() const { return texture != kNoTexture; }
    friend bool operator==(const TextureMap&, const TextureMap&) = default;
};

// The most samples that are averaged along the longer axis of what a pixel covers.
inline constexpr int kMaxTaps = 16;

// What a pixel covers of a surface, in the surface's uv: the axes of an ellipse around the point,
// full widths. 0: a point.
struct Footprint {
    glm::vec2 major{0.0f};
    glm::vec2 minor{0.0f};
};

// The texture's linear RGBA around `uv` (the surface's), averaged over the footprint, with the
// map's base and gain applied to all four. Never aliases where the footprint is right: up to
// kMaxTaps trilinear samples along the major axis; squares of a checker are integrated.
glm::vec4 sample(const Texture& texture, const TextureMap& map, const glm::vec2& uv,
                 const Footprint& footprint = {});

}  // namespace raypick
