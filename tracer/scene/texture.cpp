#include "tracer/scene/texture.h"

#include "tracer/geometry/absolute.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace raypick {

namespace {

constexpr float kLargestCoordinate = 1e9f;  // beyond it, and for NaN, coordinates mean nothing

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
    if (taps.width > 0.0f && longer > taps.width) {
        taps.count = std::clamp(static_cast<int>(std::ceil(longer / taps.width)), 1, kMaxTaps);
    }
    return taps;
}

// Where the middle of sample i of n lies on an axis of full width 1 around 0.
float tap_offset(int i, int n) {
    return (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 0.5f;
}

// --- Images -------------------------------------------------------------------------------------

// Four channels, in the compiler's own vector type.
using Channels = float __attribute__((vector_size(16)));

Channels all(float x) {
    return Channels{x, x, x, x};
}
Channels mix(Channels x, Channels y, float share) {
    return x * all(1.0f - share) + y * all(share);
}

// std::floor of what an int can hold, which is a call where processors need not have it.
int floor_of(float x) {
    const int whole = static_cast<int>(x);
    return x < static_cast<float>(whole) ? whole - 1 : whole;
}

// Coordinate to [0, 1], or [0, 2] for mirrored images, whose second half is turned round.
float wrapped(float x, Wrap wrap) {
    if (!(std::abs(x) < kLargestCoordinate)) return 0.0f;
    switch (wrap) {
        case Wrap::clamp:
            return std::clamp(x, 0.0f, 1.0f);
        case Wrap::mirror:
            return x - 2.0f * static_cast<float>(floor_of(0.5f * x));
        case Wrap::repeat:
            break;
    }
    return x - static_cast<float>(floor_of(x));
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

// What the bytes of a linear image mean, and of alpha in any.
constexpr std::array<float, 256> kLinearValues = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(i) * (1.0f / 255.0f);
    return values;
}();

// Looks values of one image of a mip chain up, at coordinates that are wrapped() already; row 0 is
// on top, where v is 1.
class LevelSampler {
public:
    LevelSampler(const TexturePixels& pixels, int number, const TextureMap& map)
        : LevelSampler(pixels, pixels.levels[static_cast<std::size_t>(number)], map) {}

    [[nodiscard]] Channels nearest(const glm::vec2& t) const {
        return value(row_of(floor_of((1.0f - t.y) * rows_)), col_of(floor_of(t.x * cols_)));
    }

    [[nodiscard]] Channels bilinear(const glm::vec2& t) const {
        const float x = t.x * cols_ - 0.5f;
        const float y = (1.0f - t.y) * rows_ - 0.5f;
        const int left = floor_of(x);
        const int top = floor_of(y);
        const float right = x - static_cast<float>(left);
        const std::size_t col = col_of(left);
        const std::size_t next_col = col_of(left + 1);
        const std::size_t row = row_of(top);
        const std::size_t next_row = row_of(top + 1);
        return mix(mix(value(row, col), value(row, next_col), right),
                   mix(value(next_row, col), value(next_row, next_col), right),
                   y - static_cast<float>(top));
    }

private:
    LevelSampler(const TexturePixels& pixels, const TextureLevel& level, const TextureMap& map)
        : level_(level),
          texels_(&pixels.texels[level.first]),
          rows_(static_cast<float>(level.rows)),
          cols_(static_cast<float>(level.cols)),
          wrap_u_(map.wrap_u),
          wrap_v_(map.wrap_v),
          colour_(pixels.coding == TexelCoding::linear ? kLinearValues
                                                       : texel_values(pixels.coding)) {}

    // A texel's place is that of its row plus that of its column. Mirrored v is turned round by
    // wrapped(): rows count from v = 1 downwards there.
    [[nodiscard]] std::size_t row_of(int row) const {
        return static_cast<std::size_t>(wrapped(row, level_.rows, wrap_v_)) *
               static_cast<std::size_t>(level_.cols);
    }
    [[nodiscard]] std::size_t col_of(int col) const {
        return static_cast<std::size_t>(wrapped(col, level_.cols, wrap_u_));
    }
    [[nodiscard]] Channels value(std::size_t row, std::size_t col) const {
        const glm::u8vec4& c = texels_[row + col];
        return Channels{colour_[c.x], colour_[c.y], colour_[c.z], kLinearValues[c.w]};
    }

    const TextureLevel& level_;
    const glm::u8vec4* texels_;
    float rows_;
    float cols_;
    Wrap wrap_u_;
    Wrap wrap_v_;
    const std::array<float, 256>& colour_;
};

// Looks values of an image up at one level of detail, between two images of its mip chain.
class MipSampler {
public:
    MipSampler(const TexturePixels& pixels, const TextureMap& map, float level)
        : map_(map),
          fraction_(level - static_cast<float>(static_cast<int>(level))),
          nearest_(level == 0.0f && map.filter == TextureFilter::nearest),
          finer_(pixels, static_cast<int>(level), map),
          coarser_(pixels, static_cast<int>(level) + (fraction_ == 0.0f ? 0 : 1), map) {}

    // Trilinear. The filter `nearest` is for texels larger than pixels: smaller ones are averaged.
    [[nodiscard]] Channels at(const glm::vec2& t) const {
        const glm::vec2 inside(wrapped(t.x, map_.wrap_u), wrapped(t.y, map_.wrap_v));
        if (nearest_) return finer_.nearest(inside);
        const Channels colour = finer_.bilinear(inside);
        if (fraction_ == 0.0f) return colour;
        return mix(colour, coarser_.bilinear(inside), fraction_);
    }

private:
    const TextureMap& map_;
    float fraction_;
    bool nearest_;
    LevelSampler finer_;
    LevelSampler coarser_;
};

// The level of detail of samples this many texels of the finest image wide, at least 1.
float level_of(const TexturePixels& pixels, float width) {
    if (width == 1.0f) return 0.0f;
    return std::min(std::log2(width), static_cast<float>(pixels.levels.size() - 1));
}

// Averages around t over the parallelogram of the axes a and b (texture coordinates).
Channels average(const TexturePixels& pixels, const TextureMap& map, const glm::vec2& t,
                 glm::vec2 a, glm::vec2 b) {
    const TextureLevel& base = pixels.levels.front();
    const glm::vec2 size(base.cols, base.rows);
    float longer = glm::length(a * size);
    float shorter = glm::length(b * size);
    if (shorter > longer) {
        std::swap(longer, shorter);
        std::swap(a, b);
    }
    const Taps taps = taps_along(longer, shorter, 1.0f);
    const MipSampler sampler(pixels, map, level_of(pixels, taps.width));
    if (taps.count == 1) return sampler.at(t);
    Channels sum = all(0.0f);
    for (int i = 0; i < taps.count; ++i)
        sum += sampler.at(t + tap_offset(i, taps.count) * a);
    return sum / all(static_cast<float>(taps.count));
}

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
    const glm::vec2 box = absolute(a) / static_cast<float>(taps.count) + absolute(b);
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
        const Channels channels = average(*image.pixels, map, t, a, b);
        texel = {channels[0], channels[1], channels[2], channels[3]};
    }
    return glm::vec4(map.base) + map.gain * texel;
}

}  // namespace raypick
