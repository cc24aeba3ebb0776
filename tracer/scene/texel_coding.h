// What the bytes of a texture mean: tables both ways.
#pragma once

#include "tracer/scene/srgb.h"

#include <array>
#include <cstdint>

namespace raypick {

enum class TexelCoding {
    srgb,         // colours
    linear,       // normals, opacity: byte / 255
    logarithmic,  // what spans many sizes (exponents): 8192^(byte / 255 - 1), from 1/8192 to 1
};
inline constexpr float kLogarithmicSpan = 8192.0f;

// The value, 0..1, of each byte. Alpha is always linear.
const std::array<float, 256>& texel_values(TexelCoding coding);

// The byte nearest to values, nearest as the coding has it. What is outside 0..1 is clamped.
class TexelEncoder {
public:
    explicit TexelEncoder(TexelCoding coding) : coding_(coding) {}

    [[nodiscard]] std::uint8_t byte(float value) const;

private:
    TexelCoding coding_;
    SrgbEncoder srgb_;
};

}  // namespace raypick
