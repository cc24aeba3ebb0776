// A rendered frame with its channels, and its files.
#pragma once

#include "tracer/geometry/pixel.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace raypick {

// Row-major, row 0 on top. Colour is linear RGB. Pixels that show the background have depth
// infinity, normal 0, object kNoObject and primitive 0xffffffff. All channels but the colour may be
// empty.
struct Image {
    ImageSize size;
    std::vector<glm::vec3> colour;
    std::vector<float> depth;  // t along the eye ray: distance from the eye in world units
    std::vector<glm::vec3> normal;
    std::vector<std::uint32_t> object;
    std::vector<std::uint32_t> primitive;
};

// Those that an image is to have. Of 36 bytes a pixel the colour takes 12.
enum class Channels { all, colour };

// All background, black. Touching the memory of a large image for the first time takes long: up to
// `threads` threads (0: all cores) do it.
Image make_image(ImageSize size, Channels channels = Channels::all, int threads = 1);

// IEC 61966-2-1 transfer curve, and the byte that a PNG or the screen shows (NaN becomes 0).
float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);
std::uint8_t srgb_byte(float linear);

// Writes by the name's ending: .png (8-bit sRGB) or .exr (float R G B, depth as Z, N.X N.Y N.Z, and
// unsigned-integer object_id, primitive_id, of which the image has). Written beside the target and
// renamed, so that a failure leaves no half file. Throws FileError.
void write_image(const Image& image, const std::filesystem::path& file);
// True if write_image makes a PNG of it.
bool is_png_name(const std::filesystem::path& file);
// "" if write_image can write to that name, else what is wrong with it.
std::string unsupported_image_name(const std::filesystem::path& file);
// The same for an image of this size: a PNG holds up to 1 GiB of uncompressed bytes.
std::string unsupported_image(const std::filesystem::path& file, ImageSize size);

}  // namespace raypick
