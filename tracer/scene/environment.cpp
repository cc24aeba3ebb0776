#include "tracer/scene/environment.h"

#include "tracer/error.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/texture.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

glm::vec3 gradient(const GradientSky& sky, const glm::vec3& direction) {
    const float height = glm::dot(direction, glm::vec3(glm::normalize(sky.up)));
    return glm::mix(sky.horizon, height < 0.0f ? sky.ground : sky.zenith,
                    std::min(1.0f, std::abs(height)));
}

// --- Mip chain ----------------------------------------------------------------------------------

// How much of the sphere each row of texels covers, up to a factor.
std::vector<double> row_areas(int rows) {
    std::vector<double> areas;
    areas.reserve(static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row)
        areas.push_back(std::sin(glm::pi<double>() * (row + 0.5) / rows));
    return areas;
}

// Rows and columns halved, rounded down. Texels count by the area that they cover on the sphere.
SkyPixels halved(const SkyPixels& from) {
    SkyPixels to;
    to.rows = std::max(1, from.rows / 2);
    to.cols = std::max(1, from.cols / 2);
    to.texels.reserve(static_cast<std::size_t>(to.rows) * static_cast<std::size_t>(to.cols));
    const std::vector<double> areas = row_areas(from.rows);
    // Texel i covers [i, i + 1) * from / to of the texels before: whole ones and parts at the ends.
    const auto each_covered = [](int i, int from_count, int to_count, const auto& visit) {
        const double step = static_cast<double>(from_count) / to_count;
        const double begin = i * step;
        const double end = begin + step;
        for (int k = static_cast<int>(begin); k < from_count && k < end; ++k)
            visit(k, std::min<double>(k + 1, end) - std::max<double>(k, begin));
    };
    for (int row = 0; row < to.rows; ++row) {
        for (int col = 0; col < to.cols; ++col) {
            glm::dvec3 sum(0.0);
            double weight = 0.0;
            each_covered(row, from.rows, to.rows, [&](int r, double height) {
                const double area = height * areas[static_cast<std::size_t>(r)];
                each_covered(col, from.cols, to.cols, [&](int c, double width) {
                    const auto i =
                        static_cast<std::size_t>(r) * static_cast<std::size_t>(from.cols) +
                        static_cast<std::size_t>(c);
                    sum += area * width * glm::dvec3(from.texels[i]);
                    weight += area * width;
                });
            });
            to.texels.emplace_back(sum / weight);
        }
    }
    return to;
}

// A NaN would spread over all of the mip chain.
void check_light(const std::vector<glm::vec3>& texels) {
    for (std::size_t i = 0; i < texels.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const float light = texels[i][k];
            if (light >= 0.0f && static_cast<double>(light) <= kMostLight) continue;
            throw Error(
                fmt::format("texel {} holds {}: light is a number from 0 to 1e18", i, light));
        }
    }
}

// --- Sampling -----------------------------------------------------------------------------------

// Beyond a pole the image goes on upside down on the other side of the sphere.
glm::vec3 texel(const SkyPixels& pixels, int row, int col) {
    if (row < 0 || row >= pixels.rows) {
        row = row < 0 ? -1 - row : 2 * pixels.rows - 1 - row;
        col += pixels.cols / 2;
    }
    col = (col % pixels.cols + pixels.cols) % pixels.cols;
    return pixels.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.cols) +
                         static_cast<std::size_t>(col)];
}

// u and v run from 0 to 1 over columns and rows.
glm::vec3 bilinear(const SkyPixels& pixels, float u, float v) {
    const float x = u * static_cast<float>(pixels.cols) - 0.5f;
    const float y = v * static_cast<float>(pixels.rows) - 0.5f;
    const float left = std::floor(x);
    const float top = std::floor(y);
    const int col = static_cast<int>(left);
    const int row = static_cast<int>(top);
    const float right = x - left;
    return glm::mix(glm::mix(texel(pixels, row, col), texel(pixels, row, col + 1), right),
                    glm::mix(texel(pixels, row + 1, col), texel(pixels, row + 1, col + 1), right),
                    y - top);
}

const SkyPixels& sky_level(const SkyPixels& pixels, int level) {
    return level == 0 ? pixels : pixels.smaller[static_cast<std::size_t>(level - 1)];
}

glm::vec3 trilinear(const SkyPixels& pixels, float level, float u, float v) {
    const int finer = static_cast<int>(level);
    const float fraction = level - static_cast<float>(finer);
    const glm::vec3 colour = bilinear(sky_level(pixels, finer), u, v);
    if (fraction == 0.0f) return colour;
    return glm::mix(colour, bilinear(sky_level(pixels, finer + 1), u, v), fraction);
}

// Rows are as far apart everywhere, so they choose the level; towards the poles the same angle
// covers more and more columns, which more samples along the row make up for.
glm::vec3 averaged(const SkyPixels& pixels, float u, float v, float spread, float cos_height) {
    const float rows = spread / glm::pi<float>() * static_cast<float>(pixels.rows);
    const auto last = static_cast<float>(pixels.smaller.size());
    const float level = rows > 1.0f ? std::min(std::log2(rows), last) : 0.0f;
    const float wide =
        std::min(1.0f, spread / (glm::two_pi<float>() * std::max(cos_height, 1e-6f)));
    const float texels = wide * static_cast<float>(pixels.cols) / std::max(rows, 1.0f);
    const int taps = std::clamp(static_cast<int>(std::ceil(texels)), 1, kMaxTaps);
    glm::vec3 sum(0.0f);
    for (int i = 0; i < taps; ++i) {
        const float offset = (static_cast<float>(i) + 0.5f) / static_cast<float>(taps) - 0.5f;
        sum += trilinear(pixels, level, u + wide * offset, v);
    }
    return sum / static_cast<float>(taps);
}

glm::vec3 image_colour(const ImageSky& sky, const glm::vec3& direction, float spread) {
    const glm::dvec3 up = glm::normalize(sky.up);
    const glm::dvec3 right = glm::normalize(glm::cross(sky.forward, up));
    const glm::dvec3 forward = glm::cross(up, right);
    const float x = glm::dot(direction, glm::vec3(right));
    const float y = std::clamp(glm::dot(direction, glm::vec3(up)), -1.0f, 1.0f);
    const float z = glm::dot(direction, glm::vec3(forward));
    const float cos_height = std::sqrt(x * x + z * z);
    const float u = 0.5f + std::atan2(x, z) / glm::two_pi<float>();
    const float v = std::atan2(cos_height, y) / glm::pi<float>();
    return sky.scale * averaged(*sky.pixels, u, v, spread, cos_height);
}

}  // namespace

std::shared_ptr<const SkyPixels> make_sky_pixels(int rows, int cols,
                                                 std::vector<glm::vec3> texels) {
    if (rows <= 0 || cols <= 0 ||
        texels.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)) {
        throw Error(fmt::format("{} texels are no image of {} x {}", texels.size(), cols, rows));
    }
    check_light(texels);
    auto pixels = std::make_shared<SkyPixels>();
    pixels->rows = rows;
    pixels->cols = cols;
    pixels->texels = std::move(texels);
    for (const SkyPixels* last = pixels.get(); last->rows > 1 || last->cols > 1;
         last = &pixels->smaller.back()) {
        pixels->smaller.push_back(halved(*last));
    }
    return pixels;
}

glm::vec3 environment_colour(const Scene& scene, const glm::vec3& direction, float spread) {
    if (const auto* sky = std::get_if<GradientSky>(&scene.environment)) {
        return gradient(*sky, direction);
    }
    if (const auto* sky = std::get_if<ImageSky>(&scene.environment)) {
        return image_colour(*sky, direction, spread);
    }
    return scene.background;
}

}  // namespace raypick
