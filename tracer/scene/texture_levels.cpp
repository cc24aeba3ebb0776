// The mip chain of an image.
#include "tracer/error.h"
#include "tracer/scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

// The texels of a row or column that one of the next level covers, with their shares: two, or three
// where the number of texels is odd. (Guthe, Heckbert, "Non-Power-of-Two Mipmap Creation", NVIDIA
// 2005: a polyphase box filter.)
struct Cover {
    int first = 0;
    int count = 1;
    std::array<float, 3> share{1.0f, 0.0f, 0.0f};
};

std::vector<Cover> covers(int from, int to) {
    std::vector<Cover> covers(static_cast<std::size_t>(to));
    const auto n = static_cast<float>(to);
    const auto all = static_cast<float>(from);
    for (int i = 0; i < to; ++i) {
        Cover& cover = covers[static_cast<std::size_t>(i)];
        if (from == 1) continue;
        cover.first = 2 * i;
        if (from % 2 == 0) {
            cover.count = 2;
            cover.share = {0.5f, 0.5f, 0.0f};
        } else {
            cover.count = 3;
            cover.share = {(n - static_cast<float>(i)) / all, n / all,
                           static_cast<float>(i + 1) / all};
        }
    }
    return covers;
}

// An image's linear values, row by row.
class LinearRows {
public:
    LinearRows(const std::vector<glm::u8vec4>& bytes, TexelCoding coding, int cols)
        : bytes_(&bytes), coding_(coding), cols_(cols) {}
    LinearRows(const std::vector<glm::vec4>& values, int cols) : values_(&values), cols_(cols) {}

    // Adds share * row to `sum`.
    void add(int row, float share, std::vector<glm::vec4>& sum) const {
        const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_);
        if (values_ != nullptr) {
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += share * (*values_)[first + i];
            return;
        }
        const std::array<float, 256>& values = texel_values(coding_);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const glm::u8vec4& c = (*bytes_)[first + i];
            const glm::vec4 value = coding_ == TexelCoding::linear
                                        ? glm::vec4(c) * (1.0f / 255.0f)
                                        : glm::vec4(values[c.x], values[c.y], values[c.z],
                                                    static_cast<float>(c.w) * (1.0f / 255.0f));
            sum[i] += share * value;
        }
    }

private:
    const std::vector<glm::u8vec4>* bytes_ = nullptr;
    const std::vector<glm::vec4>* values_ = nullptr;
    TexelCoding coding_ = TexelCoding::linear;
    int cols_;
};

std::vector<glm::vec4> halved(const LinearRows& rows, const TextureLevel& from,
                              const TextureLevel& to) {
    const std::vector<Cover> row_covers = covers(from.rows, to.rows);
    const std::vector<Cover> col_covers = covers(from.cols, to.cols);
    std::vector<glm::vec4> result;
    result.reserve(static_cast<std::size_t>(to.rows) * static_cast<std::size_t>(to.cols));
    std::vector<glm::vec4> sum(static_cast<std::size_t>(from.cols));
    for (const Cover& row : row_covers) {
        std::fill(sum.begin(), sum.end(), glm::vec4(0.0f));
        for (int i = 0; i < row.count; ++i)
            rows.add(row.first + i, row.share[static_cast<std::size_t>(i)], sum);
        for (const Cover& col : col_covers) {
            const auto first = static_cast<std::size_t>(col.first);
            glm::vec4 value(0.0f);
            for (std::size_t i = 0; i < static_cast<std::size_t>(col.count); ++i)
                value += col.share[i] * sum[first + i];
            result.push_back(value);
        }
    }
    return result;
}

void append(const std::vector<glm::vec4>& values, const TexelEncoder& coded,
            TexturePixels& pixels) {
    const TexelEncoder alpha(TexelCoding::linear);
    for (const glm::vec4& c : values) {
        pixels.texels.emplace_back(coded.byte(c.x), coded.byte(c.y), coded.byte(c.z),
                                   alpha.byte(c.w));
    }
}

}  // namespace

std::shared_ptr<const TexturePixels> make_texture_pixels(int rows, int cols,
                                                         std::vector<glm::u8vec4> texels,
                                                         TexelCoding coding) {
    if (rows <= 0 || cols <= 0 ||
        texels.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)) {
        throw Error(fmt::format("{} texels are no image of {} x {}", texels.size(), cols, rows));
    }
    auto pixels = std::make_shared<TexturePixels>();
    pixels->coding = coding;
    pixels->levels = {{rows, cols, 0}};
    pixels->texels = std::move(texels);
    const TexelEncoder coded(coding);
    std::vector<glm::vec4> values;  // of the level before, not rounded to bytes; empty: the image
    while (rows > 1 || cols > 1) {
        const TextureLevel from = pixels->levels.back();
        rows = std::max(1, rows / 2);
        cols = std::max(1, cols / 2);
        const TextureLevel to{rows, cols, pixels->texels.size()};
        values = halved(values.empty() ? LinearRows(pixels->texels, coding, from.cols)
                                       : LinearRows(values, from.cols),
                        from, to);
        pixels->levels.push_back(to);
        append(values, coded, *pixels);
    }
    return pixels;
}

}  // namespace raypick
