#include "tracer/render/image.h"

#include "tracer/accel/hit.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"
#include "tracer/render/image_files.h"
#include "tracer/render/large_pages.h"
#include "tracer/temporary_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace raypick {

namespace {

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace

Image make_image(ImageSize size, Channels channels, int threads) {
    const std::size_t count = size.pixel_count();
    Image image;
    image.size = size;
    const auto fill = [&](std::size_t channel) {
        switch (channel) {  // the colour, then the largest
            case 0:
                return fill_large(image.colour, count, glm::vec3(0.0f));
            case 1:
                return fill_large(image.normal, count, glm::vec3(0.0f));
            case 2:
                return fill_large(image.depth, count, std::numeric_limits<float>::infinity());
            case 3:
                return fill_large(image.object, count, kNoObject);
            default:
                return fill_large(image.primitive, count, 0xffffffffu);
        }
    };
    const std::size_t wanted = channels == Channels::all ? 5 : 1;
    if (threads == 1) {
        for (std::size_t channel = 0; channel < wanted; ++channel)
            fill(channel);
    } else {
        parallel_for(wanted, threads, {}, fill);
    }
    return image;
}

float srgb_from_linear(float linear) {
    if (linear <= 0.0031308f) return 12.92f * linear;
    return 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linear_from_srgb(float srgb) {
    if (srgb <= 0.04045f) return srgb / 12.92f;
    return std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t srgb_byte(float linear) {
    if (!(linear > 0.0f)) return 0;
    if (linear >= 1.0f) return 255;
    return static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(linear)));
}

bool is_png_name(const std::filesystem::path& file) {
    return lower_extension(file) == ".png";
}

std::string unsupported_image_name(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".png" || extension == ".exr") return "";
    return "images are written as .png or .exr, not \"" + file.extension().string() + "\"";
}

std::string unsupported_image(const std::filesystem::path& file, ImageSize size) {
    std::string problem = unsupported_image_name(file);
    if (problem.empty() && is_png_name(file) && !fits_png(size)) {
        problem = "too large for a PNG: write .exr instead";
    }
    return problem;
}

void write_image(const Image& image, const std::filesystem::path& file) {
    if (const std::string problem = unsupported_image(file, image.size); !problem.empty()) {
        throw FileError(file.string(), problem);
    }
    if (image.size.rows <= 0 || image.size.cols <= 0) {
        throw FileError(file.string(), "can't be written: the image has no pixels");
    }
    TemporaryFile temporary(file);
    if (is_png_name(file)) {
        write_png_file(image, temporary.path(), file);
    } else {
        write_exr_file(image, temporary.path(), file);
    }
    temporary.rename();
}

}  // namespace raypick
