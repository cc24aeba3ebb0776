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

#include <algorithm>
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

// A file in memory, which notes when bytes are asked for that it doesn't have. stb itself says
// nothing of it in TGA, BMP and HDR and shows what was in its memory.
struct Bytes {
    std::string_view left;
    const char* buffer = nullptr;  // stb's own, filled ahead of what is needed
    bool cut_short = false;
};

int read_bytes(void* user, char* to, int size) {
    auto& bytes = *static_cast<Bytes*>(user);
    if (bytes.buffer == nullptr) bytes.buffer = to;  // that comes first
    const std::size_t count = std::min(static_cast<std::size_t>(size), bytes.left.size());
    std::memcpy(to, bytes.left.data(), count);
    bytes.left.remove_prefix(count);
    const bool enough = to == bytes.buffer ? count > 0 : count == static_cast<std::size_t>(size);
    if (!enough) bytes.cut_short = true;
    return static_cast<int>(count);
}

void skip_bytes(void* user, int count) {
    auto& bytes = *static_cast<Bytes*>(user);
    bytes.left.remove_prefix(std::min(static_cast<std::size_t>(count), bytes.left.size()));
}

int no_bytes_left(void* user) {
    return static_cast<const Bytes*>(user)->left.empty() ? 1 : 0;
}

[[noreturn]] void fail_with_reason() {
    const char* const reason = stbi_failure_reason();
    throw Error(fmt::format("is a broken image ({})", reason != nullptr ? reason : "unknown"));
}

// The texels as four channels each; `load` is one of stb's functions.
template <typename T, typename Load>
StbPixels<T> decoded(std::string_view file, const Load& load) {
    const stbi_io_callbacks callbacks{read_bytes, skip_bytes, no_bytes_left};
    Bytes bytes{file};
    int rows = 0;
    int cols = 0;
    int channels = 0;
    StbPixels<T> pixels(load(&callbacks, &bytes, &cols, &rows, &channels, 4), &stbi_image_free);
    if (!pixels) fail_with_reason();
    if (bytes.cut_short) throw Error("is cut short: it ends before its last texel");
    return pixels;
}

FloatImage float_image(std::string_view bytes, int rows, int cols) {
    const StbPixels<float> pixels = decoded<float>(bytes, stbi_loadf_from_callbacks);
    FloatImage image{rows, cols, {}};
    image.texels.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols));
    const float* value = pixels.get();
    for (glm::vec4& texel : image.texels) {
        texel = glm::vec4(light_or_zero(value[0]), light_or_zero(value[1]), light_or_zero(value[2]),
                          1.0f);
        value += 4;
    }
    return image;
}

ByteImage byte_image(std::string_view bytes, int rows, int cols) {
    const auto pixels = decoded<unsigned char>(bytes, stbi_load_from_callbacks);
    ByteImage image{rows, cols, {}};
    const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    // A texture's smaller levels will follow them, a third as many, and the last ones' ends.
    image.texels.reserve(count + count / 3 + static_cast<std::size_t>(rows + cols));
    const auto* const texels = reinterpret_cast<const glm::u8vec4*>(pixels.get());
    image.texels.assign(texels, texels + count);
    return image;
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
    if (stbi_is_hdr_from_memory(data, size) != 0) return float_image(bytes, rows, cols);
    return byte_image(bytes, rows, cols);
}

}  // namespace raypick
