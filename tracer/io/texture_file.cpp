#include "tracer/io/texture_file.h"

#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/scene/srgb.h"

#include <array>
#include <new>
#include <utility>

namespace raypick {

namespace {

// Decodes a file and makes something of it; what goes wrong names the file.
template <typename Make>
auto of_file(const std::filesystem::path& file, const Make& make) {
    const FileBytes bytes = read_file(file);
    try {
        return make(decode_image(bytes.view()));
    } catch (const std::bad_alloc&) {
        throw FileError(file.string(), "needs more memory than there is");
    } catch (const Error& error) {
        throw FileError(file.string(), error.what());
    }
}

std::vector<glm::u8vec4> bytes_of(const FloatImage& image, TexelCoding coding) {
    const TexelEncoder coded(coding);
    const TexelEncoder alpha(TexelCoding::linear);
    std::vector<glm::u8vec4> texels;
    texels.reserve(image.texels.size());
    for (const glm::vec4& c : image.texels) {
        texels.emplace_back(coded.byte(c.x), coded.byte(c.y), coded.byte(c.z), alpha.byte(c.w));
    }
    return texels;
}

}  // namespace

ByteImage as_bytes(DecodedImage image, TexelCoding coding) {
    if (auto* bytes = std::get_if<ByteImage>(&image)) return std::move(*bytes);
    const auto& floats = std::get<FloatImage>(image);
    return {floats.rows, floats.cols, bytes_of(floats, coding)};
}

std::shared_ptr<const TexturePixels> read_texture(const std::filesystem::path& file,
                                                  TexelCoding coding) {
    return of_file(file, [&](DecodedImage image) {
        ByteImage bytes = as_bytes(std::move(image), coding);
        return make_texture_pixels(bytes.rows, bytes.cols, std::move(bytes.texels), coding);
    });
}

std::shared_ptr<const SkyPixels> read_sky(const std::filesystem::path& file) {
    return of_file(file, [](const DecodedImage& image) {
        std::vector<glm::vec3> texels;
        if (const auto* bytes = std::get_if<ByteImage>(&image)) {
            const std::array<float, 256>& linear = srgb_to_linear_table();
            texels.reserve(bytes->texels.size());
            for (const glm::u8vec4& c : bytes->texels)
                texels.emplace_back(linear[c.x], linear[c.y], linear[c.z]);
            return make_sky_pixels(bytes->rows, bytes->cols, std::move(texels));
        }
        const auto& floats = std::get<FloatImage>(image);
        texels.assign(floats.texels.begin(), floats.texels.end());
        return make_sky_pixels(floats.rows, floats.cols, std::move(texels));
    });
}

std::shared_ptr<const TexturePixels> placeholder_texture() {
    constexpr int kSide = 64;
    constexpr int kSquare = 8;
    const glm::u8vec4 magenta(255, 0, 255, 255);
    const glm::u8vec4 black(0, 0, 0, 255);
    std::vector<glm::u8vec4> texels;
    texels.reserve(std::size_t{kSide} * kSide);
    for (int row = 0; row < kSide; ++row) {
        for (int col = 0; col < kSide; ++col)
            texels.push_back((row / kSquare + col / kSquare) % 2 == 0 ? magenta : black);
    }
    return make_texture_pixels(kSide, kSide, std::move(texels), TexelCoding::srgb);
}

}  // namespace raypick
