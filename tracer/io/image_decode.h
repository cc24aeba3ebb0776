// Image files as pixels: PNG, JPEG, TGA, BMP, Radiance HDR, OpenEXR, told apart by content.
#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec4.hpp>

#include <string_view>
#include <variant>
#include <vector>

namespace raypick {

// Row 0 on top.
struct ByteImage {  // PNG, JPEG, TGA, BMP: as the file has them, 16 bits cut to 8
    int rows = 0;
    int cols = 0;
    std::vector<glm::u8vec4> texels;  // opaque if the file has no alpha, grey as r = g = b
};
struct FloatImage {  // HDR, EXR: linear; finite and not negative
    int rows = 0;
    int cols = 0;
    std::vector<glm::vec4> texels;
};
using DecodedImage = std::variant<ByteImage, FloatImage>;

// The largest image that is read, in texels: 8192 x 8192. The size is looked at before any memory
// is asked for.
inline constexpr int kMostTexels = 1 << 26;

// `bytes` is a whole file. Throws Error that says what is wrong with it.
DecodedImage decode_image(std::string_view bytes);

// The parts of decode_image that need OpenEXR.
bool is_exr(std::string_view bytes);
FloatImage decode_exr(std::string_view bytes);

// Throws Error unless an image of this size is read.
void check_image_size(long long rows, long long cols);
// Makes a value of a file finite and not negative.
float light_or_zero(float value);

}  // namespace raypick
