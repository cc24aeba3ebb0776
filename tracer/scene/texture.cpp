#include "tracer/scene/texture.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace raypick {

namespace {

constexpr float kLargestCoordinate = 1e9f;  // beyond it, and for NaN, coordinates mean nothing
constexpr int kMaxTaps = 16;

// The samples along the longer axis of a footprint that together cover it.
struct Taps {
    int count = 1;
    float width = 0.0f;  // of one sample, across the longer axis; the unit is that of the axes
};

// At least `least` wide: what is narrower than a texel needs no more samples.
Taps taps_along(float longer, float shorter, float least) {
    Taps taps;
    taps.width = std::max(std::max(shorter, longer / static_cast<float>(kMaxTaps)), least);
    if (!(taps.width < kLargestCoordinate)) return {1, kLargestCoordinate};
    if (taps.width > 0.0f) {
        taps.count = std::clamp(static_cast<int>(std::ceil(longer / taps.width)), 1, kMaxTaps);
    }
    return taps;
}

// Where the middle of sample i of n lies on an axis of full width 1 around 0.
float tap_offset(int i, int n) {
    return (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 0.5f;
}

// --- Images -------------------------------------------------------------------------------------

// Coordinate to [0, 1], or [0, 2] for mirrored images, whose second half is turned round.
float wrapped(float x, Wrap wrap) {
    if (!(std::abs(x) < kLargestCoordinate)) return 0.0f;
    switch (wrap) {
        case Wrap::clamp:
            return std::clamp(x, 0.0f, 1.0f);
        case Wrap::mirror:
            return x - 2.0f * std::floor(0.5f * x);
        case Wrap::repeat:
            break;
    }
    return x - std::floor(x);
}

// i in [-n, 2n) to [0, n). A division would take longer than all else that finds a texel.
int in_period(int i, int n) {
    if (i < 0) return i + n;
    return i < n ? i : i - n;
}

// Texel i of n; i is at most one texel outside what wrapped() leaves.
int wrapped(int i, int n, Wrap wrap) {
    switch (wrap) {
        case Wrap::clamp:
            return std::clamp(i, 0, n - 1);
        case Wrap::mirror: {
            const int turned = in_period(i, 2 * n);
            return turned < n ? turned : 2 * n - 1 - turned;
        }
        case Wrap::repeat:
            break;
    }
    return in_period(i, n);
}

class ImageSampler {
public:
    ImageSampler(const TexturePixels& pixels, const TextureMap& map)
        : pixels_(pixels), map_(map), values_(texel_values(pixels.coding)) {}

    // Averages around t over the parallelogram of the axes a and b (texture coordinates).
    [[nodiscard]] glm::vec4 average(const glm::vec2& t, glm::vec2 a, glm::vec2 b) const {
        const TextureLevel& base = pixels_.levels.front();
        const glm::vec2 size(base.cols, base.rows);
        float longer = glm::length(a * size);
        float shorter = glm::length(b * size);
        if (shorter > longer) {
            std::swap(longer, shorter);
            std::swap(a, b);
        }
        const Taps taps = taps_along(longer, shorter, 1.0f);
        const float level = std::min(std::log2(taps.width), static_cast<float>(last_level()));
        if (taps.count == 1) return at_level(t, level);
        glm::vec4 sum(0.0f);
        for (int i = 0; i < taps.count; ++i)
            sum += at_level(t + tap_offset(i, taps.count) * a, level);
        return sum / static_cast<float>(taps.count);
    }

private:
    [[nodiscard]] int last_level() const { return static_cast<int>(pixels_.levels.size()) - 1; }

    // Trilinear. The filter `nearest` is for texels larger than pixels: smaller ones are averaged.
    [[nodiscard]] glm::vec4 at_level(const glm::vec2& t, float level) const {
        const int finer = static_cast<int>(level);
        const float fraction = level - static_cast<float>(finer);
        if (level == 0.0f && map_.filter == TextureFilter::nearest) return nearest(t);
        const glm::vec4 colour = bilinear(t, finer);
        if (fraction == 0.0f) return colour;
        return glm::mix(colour, bilinear(t, finer + 1), fraction);
    }

    [[nodiscard]] glm::vec4 nearest(const glm::vec2& t) const {
        const TextureLevel& level = pixels_.levels.front();
        const float x = wrapped(t.x, map_.wrap_u) * static_cast<float>(level.cols);
        const float y = (1.0f - wrapped(t.y, map_.wrap_v)) * static_cast<float>(level.rows);
        return value(row_of(level, static_cast<int>(std::floor(
                                       y)))[col_of(level, static_cast<int>(std::floor(x)))]);
    }

    [[nodiscard]] glm::vec4 bilinear(const glm::vec2& t, int number) const {
        const TextureLevel& level = pixels_.levels[static_cast<std::size_t>(number)];
        // Row 0 is on top, where v is 1.
        const float x = wrapped(t.x, map_.wrap_u) * static_cast<float>(level.cols) - 0.5f;
        const float y = (1.0f - wrapped(t.y, map_.wrap_v)) * static_cast<float>(level.rows) - 0.5f;
        const float left = std::floor(x);
        const float top = std::floor(y);
        const float right = x - left;
        const std::size_t col = col_of(level, static_cast<int>(left));
        const std::size_t next_col = col_of(level, static_cast<int>(left) + 1);
        const glm::u8vec4* row = row_of(level, static_cast<int>(top));
        const glm::u8vec4* next_row = row_of(level, static_cast<int>(top) + 1);
        return glm::mix(glm::mix(value(row[col]), value(row[next_col]), right),
                        glm::mix(value(next_row[col]), value(next_row[next_col]), right), y - top);
    }

    // Mirrored v is turned round by wrapped(): rows count from v = 1 downwards there.
    [[nodiscard]] const glm::u8vec4* row_of(const TextureLevel& level, int row) const {
        return &pixels_.texels[level.first] +
               static_cast<std::size_t>(wrapped(row, level.rows, map_.wrap_v)) *
                   static_cast<std::size_t>(level.cols);
    }
    [[nodiscard]] std::size_t col_of(const TextureLevel& level, int col) const {
        return static_cast<std::size_t>(wrapped(col, level.cols, map_.wrap_u));
    }

    [[nodiscard]] glm::vec4 value(const glm::u8vec4& c) const {
        if (pixels_.coding == TexelCoding::linear) return glm::vec4(c) * (1.0f / 255.0f);
        return {values_[c.x], values_[c.y], values_[c.z],
                static_cast<float>(c.w) * (1.0f / 255.0f)};
    }

    const TexturePixels& pixels_;
    const TextureMap& map_;
    const std::array<float, 256>& values_;
};

// --- Checker ------------------------------------------------------------------------------------

// The mean over [x - w/2, x + w/2] of +1 where floor(x) is even and -1 where it is odd.
float mean_sign(float x, float w) {
    if (!(std::abs(x) < kLargestCoordinate)) return 0.0f;
    const float in_period = x - 2.0f * std::floor(0.5f * x);  // [0, 2]
    if (w < 1.0f) {
        const float sign = in_period < 1.0f || in_period >= 2.0f ? 1.0f : -1.0f;
        if (!(w > 0.0f)) return sign;
        // There is one edge at most within the width.
        const float to_edge = std::abs(in_period - std::floor(in_period + 0.5f));
        return sign * std::min(1.0f, 2.0f * to_edge / w);
    }
    // From the integral of the signs from 0 on, a wave of triangles between 0 and 1.
    const auto integral = [](float end) {
        return 1.0f - std::abs(end - 2.0f * std::floor(0.5f * end) - 1.0f);
    };
    return (integral(in_period + 0.5f * w) - integral(in_period - 0.5f * w)) / w;
}

// How much of the parallelogram around t lies on even squares, by boxes around the pieces that its
// longer axis is cut into: exact if the axes of the footprint are those of the squares.
float even_share(const glm::vec2& t, glm::vec2 a, glm::vec2 b) {
    float longer = glm::length(a);
    float shorter = glm::length(b);
    if (shorter > longer) {
        std::swap(longer, shorter);
        std::swap(a, b);
    }
    const Taps taps = taps_along(longer, shorter, 0.0f);
    const glm::vec2 box = glm::abs(a) / static_cast<float>(taps.count) + glm::abs(b);
    if (!(box.x < kLargestCoordinate && box.y < kLargestCoordinate)) return 0.5f;
    float sum = 0.0f;
    for (int i = 0; i < taps.count; ++i) {
        const glm::vec2 middle = t + tap_offset(i, taps.count) * a;
        sum += mean_sign(middle.x, box.x) * mean_sign(middle.y, box.y);
    }
    return 0.5f + 0.5f * sum / static_cast<float>(taps.count);
}

}  // namespace

glm::vec4 sample(const Texture& texture, const TextureMap& map, const glm::vec2& uv,
                 const Footprint& footprint) {
    const auto mapped = [&](const glm::vec2& d, float one) {
        const glm::vec3 uv1(d, one);
        return glm::vec2(glm::dot(map.u_row, uv1), glm::dot(map.v_row, uv1));
    };
    const glm::vec2 t = mapped(uv, 1.0f);
    const glm::vec2 a = mapped(footprint.major, 0.0f);
    const glm::vec2 b = mapped(footprint.minor, 0.0f);
    glm::vec4 texel;
    if (const auto* checker = std::get_if<Checker>(&texture.source)) {
        texel = glm::mix(checker->odd, checker->even, even_share(t, a, b));
    } else {
        const auto& image = std::get<ImageTexture>(texture.source);
        texel = ImageSampler(*image.pixels, map).average(t, a, b);
    }
    return glm::vec4(map.base) + map.gain * texel;
}

}  // namespace raypick
