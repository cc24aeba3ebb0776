// The two image formats that write_image knows.
#pragma once

#include "tracer/render/image.h"

#include <filesystem>
#include <vector>

namespace raypick {

// False beyond what the PNG encoder can count.
bool fits_png(ImageSize size);
// The bytes of an 8-bit sRGB PNG file. Throws Error if they can't be made.
std::vector<std::uint8_t> png_bytes(const Image& image);

// Both write to `file`; errors are FileErrors that name `target`, where the file will be moved to.
void write_png_file(const Image& image, const std::filesystem::path& file,
                    const std::filesystem::path& target);
void write_exr_file(const Image& image, const std::filesystem::path& file,
                    const std::filesystem::path& target);

}  // namespace raypick
