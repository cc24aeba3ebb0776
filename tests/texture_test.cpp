// Look-ups of textures against the plain formulas in double.
#include "tracer/scene/texture.h"

#include "tests/random.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace raypick {
namespace {

// Random bytes, row 0 on top.
struct Bytes {
    Bytes(int row_count, int col_count, Random& random) : rows(row_count), cols(col_count) {
        for (int i = 0; i < rows * cols; ++i) {
            texels.emplace_back(random.below(256), random.below(256), random.below(256),
                                random.below(256));
        }
    }

    [[nodiscard]] Texture texture(TexelCoding coding) const {
        return {"bytes", ImageTexture{make_texture_pixels(rows, cols, texels, coding), {}}};
    }
    [[nodiscard]] glm::dvec4 value(int row, int col, TexelCoding coding) const {
        const glm::u8vec4& c = texels[static_cast<std::size_t>(row * cols + col)];
        const auto& values = texel_values(coding);
        return {values[c.x], values[c.y], values[c.z], c.w / 255.0};
    }

    int rows;
    int cols;
    std::vector<glm::u8vec4> texels;
};

// Texel i of n, however far outside.
int wrapped(int i, int n, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, n - 1);
    const int period = wrap == Wrap::mirror ? 2 * n : n;
    const int inside = ((i % period) + period) % period;
    return inside < n ? inside : period - 1 - inside;
}

glm::dvec4 wanted(const Bytes& bytes, const TextureMap& map, TexelCoding coding, double u,
                  double v) {
    const double x = u * bytes.cols;
    const double y = (1.0 - v) * bytes.rows;
    const auto texel = [&](double row, double col) {
        return bytes.value(wrapped(static_cast<int>(row), bytes.rows, map.wrap_v),
                           wrapped(static_cast<int>(col), bytes.cols, map.wrap_u), coding);
    };
    if (map.filter == TextureFilter::nearest) return texel(std::floor(y), std::floor(x));
    const double left = std::floor(x - 0.5);
    const double top = std::floor(y - 0.5);
    const double right = x - 0.5 - left;
    return glm::mix(glm::mix(texel(top, left), texel(top, left + 1), right),
                    glm::mix(texel(top + 1, left), texel(top + 1, left + 1), right), y - 0.5 - top);
}

void expect_near(const glm::vec4& got, const glm::dvec4& wanted, double tolerance) {
    for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(static_cast<double>(got[k]), wanted[k], tolerance) << k;
}

TEST(Texture, PointsOfAnyWrapFilterAndCoding) {
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Bytes bytes(1 + static_cast<int>(random.below(9)),
                          1 + static_cast<int>(random.below(9)), random);
        const auto coding = static_cast<TexelCoding>(random.below(3));
        TextureMap map;
        map.texture = 0;
        map.wrap_u = static_cast<Wrap>(random.below(3));
        map.wrap_v = static_cast<Wrap>(random.below(3));
        map.filter = static_cast<TextureFilter>(random.below(2));
        // Sixteenths of a texel and a bit: never on an edge, where rounding would decide.
        const auto coordinate = [&random](int n) {
            const int step = static_cast<int>(random.below(static_cast<std::uint32_t>(6 * n * 16)));
            return (step + 0.25 - 3 * n * 16) / 16.0 / n;
        };
        const double u = coordinate(bytes.cols);
        const double v = coordinate(bytes.rows);
        expect_near(sample(bytes.texture(coding), map, {u, v}), wanted(bytes, map, coding, u, v),
                    2e-5);
    }
}

// A footprint of 2^k texels each way is texels of level k as they are; of a longer one, the mean
// along it.
TEST(Texture, FootprintsChooseLevelsAndAverage) {
    Random random(1);
    const Bytes bytes(8, 8, random);
    const Texture texture = bytes.texture(TexelCoding::linear);
    TextureMap map;
    map.texture = 0;
    const auto mean = [&](int top, int left, int rows, int cols) {
        glm::dvec4 sum(0.0);
        for (int row = top; row < top + rows; ++row) {
            for (int col = left; col < left + cols; ++col)
                sum += bytes.value(row, col, TexelCoding::linear);
        }
        return sum / static_cast<double>(rows * cols);
    };
    const double rounding = 0.51 / 255.0;
    expect_near(sample(texture, map, {0.375f, 0.625f}, {{0.25f, 0.0f}, {0.0f, 0.25f}}),
                mean(2, 2, 2, 2), rounding);
    expect_near(sample(texture, map, {0.25f, 0.25f}, {{0.0f, 0.5f}, {0.5f, 0.0f}}),
                mean(4, 0, 4, 4), rounding);
    expect_near(sample(texture, map, {0.1f, 0.9f}, {{0.0f, 9.0f}, {8.0f, 0.0f}}), mean(0, 0, 8, 8),
                rounding);
    // Four samples of one texel each.
    expect_near(sample(texture, map, {0.5f, 0.5625f}, {{0.5f, 0.0f}, {0.0f, 0.125f}}),
                mean(3, 2, 1, 4), 1e-6);
}

TEST(Texture, CoordinatesThatMeanNothing) {
    Random random(2);
    const Bytes bytes(3, 4, random);
    const Texture texture = bytes.texture(TexelCoding::srgb);
    TextureMap map;
    map.texture = 0;
    const glm::vec4 at_0 = sample(texture, map, {0.0f, 0.0f});
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -3e9f}) {
        EXPECT_EQ(sample(texture, map, {bad, bad}), at_0);
    }
    const glm::vec4 all = sample(texture, map, {0.0f, 0.0f}, {{1e20f, 0.0f}, {0.0f, 1e20f}});
    EXPECT_EQ(sample(texture, map, {0.4f, 0.7f}, {{1e20f, 0.0f}, {0.0f, 1e20f}}), all);
}

}  // namespace
}  // namespace raypick
