#include "tracer/error.h"
#include "tracer/parallel/parallel.h"
#include "tracer/render/image_files.h"
#include "tracer/render/srgb_bytes.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

namespace raypick {

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes srgb_bytes(const Image& image) {
    constexpr std::size_t kAtOnce = 1u << 16u;  // pixels
    const SrgbBytes byte;
    const std::size_t pixels = image.colour.size();
    Bytes bytes(3 * pixels);
    parallel_for((pixels + kAtOnce - 1) / kAtOnce, 0, {}, [&](std::size_t part) {
        const std::size_t end = std::min(pixels, (part + 1) * kAtOnce);
        for (std::size_t i = part * kAtOnce; i < end; ++i) {
            for (std::size_t channel = 0; channel < 3; ++channel)
                bytes[3 * i + channel] = byte(image.colour[i][static_cast<int>(channel)]);
        }
    });
    return bytes;
}

}  // namespace

bool fits_png(ImageSize size) {
    constexpr std::int64_t kLargest = 1 << 30;  // stb_image, which reads it, counts in an int
    return (std::int64_t{3} * size.cols + 1) * size.rows <= kLargest;
}

std::vector<std::uint8_t> png_bytes(const Image& image) {
    if (image.colour.empty()) throw Error("an image without pixels can't be a PNG");
    if (!fits_png(image.size)) throw Error("too large for a PNG: write .exr instead");
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.size.cols);
    header.height = static_cast<png_uint_32>(image.size.rows);
    header.format = PNG_FORMAT_RGB;
    header.flags = PNG_IMAGE_FLAG_FAST;  // a fifth of the time, files a quarter larger
    const Bytes pixels = srgb_bytes(image);
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    Bytes file(size);
    const int written =
        png_image_write_to_memory(&header, file.data(), &size, 0, pixels.data(), 0, nullptr);
    if (written == 0) throw Error(std::string("the PNG encoder failed: ") + header.message);
    file.resize(size);
    return file;
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
