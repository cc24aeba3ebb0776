#include "tracer/io/image_decode.h"

#include "tracer/error.h"

// Not for the static analyser, which is not asked about other people's code.
#ifndef __clang_analyzer__
#define STB_IMAGE_IMPLEMENTATION
#endif
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_ONLY_HDR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace raypick {

namespace {

constexpr int kLargestSide = 1 << 15;
constexpr float kLargestLight = 65504.0f;  // the largest finite half float

template <typename T>
using StbPixels = std::unique_ptr<T, decltype(&stbi_image_free)>;

[[noreturn]] void fail_with_reason() {
    const char* const reason = stbi_failure_reason();
    throw Error(fmt::format("is a broken image ({})", reason != nullptr ? reason : "unknown"));
}

}  // namespace

void check_image_size(long long rows, long long cols) {
    if (rows > 0 && cols > 0 && rows <= kLargestSide && cols <= kLargestSide &&
        rows * cols <= kMostTexels) {
        return;
    }
    throw Error(
        fmt::format("is an image of {} x {}, which is not read: up to {} on a side and {} "
                    "in all",
                    cols, rows, kLargestSide, kMostTexels));
}

float light_or_zero(float value) {
    return value > 0.0f ? std::min(value, kLargestLight) : 0.0f;
}

DecodedImage decode_image(std::string_view bytes) {
    if (is_exr(bytes)) return decode_exr(bytes);
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw Error("is larger than any image that is read");
    }
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int rows = 0;
    int cols = 0;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &cols, &rows, &channels) == 0) {
        throw Error("is no image that is read: PNG, JPEG, TGA, BMP, HDR or EXR");
    }
    check_image_size(rows, cols);
    if (stbi_is_hdr_from_memory(data, size) != 0) {
        const StbPixels<float> pixels(
            stbi_loadf_from_memory(data, size, &cols, &rows, &channels, 4), &stbi_image_free);
        if (!pixels) fail_with_reason();
        FloatImage image{rows, cols, {}};
        image.texels.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols));
        const float* value = pixels.get();
        for (glm::vec4& texel : image.texels) {
            texel = glm::vec4(light_or_zero(value[0]), light_or_zero(value[1]),
                              light_or_zero(value[2]), 1.0f);
            value += 4;
        }
        return image;
    }
    const StbPixels<unsigned char> pixels(
        stbi_load_from_memory(data, size, &cols, &rows, &channels, 4), &stbi_image_free);
    if (!pixels) fail_with_reason();
    ByteImage image{rows, cols, {}};
    image.texels.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols));
    std::memcpy(image.texels.data(), pixels.get(), 4 * image.texels.size());
    return image;
}

}  // namespace raypick
