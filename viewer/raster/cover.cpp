#include "viewer/raster/cover.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <utility>

namespace raypick {

namespace {

// By how much, relatively, what hides must be nearer than what is hidden: far more than the tie gap
// and what rounding does to distances in shaders.
constexpr float kGap = 2e-3f;

// Pixels [first, end) of an axis.
struct PixelRange {
    int first = 0;
    int end = 0;

    [[nodiscard]] bool empty() const { return first >= end; }
};

// The pixel with the first centre beyond this, of `within` or its end.
int pixel_beyond(float at, const PixelRange& within) {
    return static_cast<int>(
        std::clamp(at + 0.5f, static_cast<float>(within.first), static_cast<float>(within.end)));
}

// The pixels of an axis that a triangle with these coordinates may take, of `count`.
PixelRange pixels_of(float a, float b, float c, int count) {
    const PixelRange all{0, count};
    return {pixel_beyond(std::min(std::min(a, b), c) - kSpotMargin, all),
            pixel_beyond(std::max(std::max(a, b), c) + kSpotMargin, all)};
}

// The line through two corners: a dx + b dy + c is 0 there and above 0 inside, where dx and dy
// count from the triangle's first corner.
struct Edge {
    float a = 0.0f;
    float b = 0.0f;
    float c = 0.0f;
    float per_a = 0.0f;
    float margin = 0.0f;  // how far a move by kSpotMargin shifts the line along a row

    Edge(const Spot& from, const Spot& to, const Spot& origin) {
        constexpr float kLeast = 1e-15f;  // keeps the quotient finite where the line is level
        a = std::abs(from.y - to.y) > kLeast ? from.y - to.y : kLeast;
        b = to.x - from.x;
        c = -a * (from.x - origin.x) - b * (from.y - origin.y);
        per_a = 1.0f / a;
        margin = kSpotMargin * (1.0f + std::abs(b * per_a));
    }
};

// A triangle at work on pixels.
class Walk {
public:
    Walk(const SpotTriangle& t, float area)
        : edges_{Edge(t[0], t[1], t[0]), Edge(t[1], t[2], t[0]), Edge(t[2], t[0], t[0])},
          origin_(t[0]),
          nearest_(std::max(std::max(t[0].nearness, t[1].nearness), t[2].nearness)) {
        const float n1 = t[1].nearness - t[0].nearness;
        const float n2 = t[2].nearness - t[0].nearness;
        // Nearness is linear on the image.
        const float per_area = 1.0f / area;
        by_x_ = (n1 * (t[2].y - t[0].y) - n2 * (t[1].y - t[0].y)) * per_area;
        by_y_ = (n2 * (t[1].x - t[0].x) - n1 * (t[2].x - t[0].x)) * per_area;
        uncertain_ = kSpotMargin * (std::abs(by_x_) + std::abs(by_y_));
    }

    // Columns of a row.
    struct Columns {
        PixelRange touched;  // their centres may be inside
        PixelRange inside;   // they are for sure
    };
    [[nodiscard]] Columns columns(int row, const PixelRange& within) const {
        const float dy = static_cast<float>(row) + 0.5f - origin_.y;
        float low = -1e9f;
        float high = 1e9f;
        float low_inside = low;
        float high_inside = high;
        for (const Edge& edge : edges_) {
            const float at = -(edge.b * dy + edge.c) * edge.per_a;
            if (edge.a > 0.0f) {
                low = std::max(low, at - edge.margin);
                low_inside = std::max(low_inside, at + edge.margin);
            } else {
                high = std::min(high, at + edge.margin);
                high_inside = std::min(high_inside, at - edge.margin);
            }
        }
        const float x = origin_.x;
        return {{pixel_beyond(x + low, within), pixel_beyond(x + high, within)},
                {pixel_beyond(x + low_inside, within), pixel_beyond(x + high_inside, within)}};
    }

    // Nearness in a row: at the centre of column 0, and how it grows by column. Where the triangle
    // is steep it is known less well: `side` 1 gives the least that it may be, -1 the greatest.
    struct Slope {
        float at_0 = 0.0f;
        float by_col = 0.0f;

        [[nodiscard]] float at(int col) const { return at_0 + by_col * static_cast<float>(col); }
    };
    [[nodiscard]] Slope nearness(int row, float side) const {
        const float dy = static_cast<float>(row) + 0.5f - origin_.y;
        return {origin_.nearness + by_y_ * dy + by_x_ * (0.5f - origin_.x) - side * uncertain_,
                by_x_};
    }
    [[nodiscard]] float nearest() const { return nearest_; }

private:
    std::array<Edge, 3> edges_;
    Spot origin_;
    float nearest_;
    float by_x_ = 0.0f;
    float by_y_ = 0.0f;
    float uncertain_ = 0.0f;
};

// Twice the triangle's, with the sign of its turn.
float twice_area(const SpotTriangle& t) {
    return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

// The triangle in the turn that has the inside above 0.
Walk walk_of(const SpotTriangle& t) {
    const float area = twice_area(t);
    return area < 0.0f ? Walk({t[0], t[2], t[1]}, -area) : Walk(t, area);
}

void raise(float& cell, float nearness) {
    std::atomic_ref<float> shared(cell);
    float now = shared.load(std::memory_order_relaxed);
    while (nearness > now &&
           !shared.compare_exchange_weak(now, nearness, std::memory_order_relaxed)) {
    }
}

}  // namespace

Cover::Cover(ImageSize size, float pixel)
    : size_(size), pixel_(pixel), nearness_(size.pixel_count()) {}

bool Cover::add(const SpotTriangle& t, bool hides) {
    const PixelRange cols = pixels_of(t[0].x, t[1].x, t[2].x, size_.cols);
    const PixelRange rows = pixels_of(t[0].y, t[1].y, t[2].y, size_.rows);
    if (cols.empty() || rows.empty()) return false;
    const Walk walk = walk_of(t);
    bool takes_pixels = false;
    for (int row = rows.first; row < rows.end; ++row) {
        const auto [touched, inside] = walk.columns(row, cols);
        takes_pixels = takes_pixels || !touched.empty();
        if (!hides || inside.empty()) continue;
        const Walk::Slope nearness = walk.nearness(row, 1.0f);
        float* const cells = nearness_.data() + static_cast<std::ptrdiff_t>(row) * size_.cols;
        for (int col = inside.first; col < inside.end; ++col)
            raise(cells[col], nearness.at(col));
    }
    return takes_pixels;
}

// How much nearer, relatively, than the triangle's plane a shader may find it where the rasteriser
// takes a pixel for it whose ray passes it by. Barycentric weights below 0, of `outside` in sum,
// are made 0 there: that moves the point where ray and plane meet towards the corners, by this
// share of what lies between. Its coordinate on the axis along which the ray runs fastest then
// gives the distance; so many times further than the point itself may that one move.
float Cover::shift(const SpotTriangle& t, float stretch) const {
    constexpr float kFastest = 1.7321f;  // no direction has all its coordinates below 1 / this
    const auto [min_x, max_x] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [min_y, max_y] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto [far, near] = std::minmax({t[0].nearness, t[1].nearness, t[2].nearness});
    const float size = (max_x - min_x) + (max_y - min_y);
    // Of each corner's weight, the margin over its height; no edge is longer than `size`.
    const float outside = 3.0f * kSpotMargin * size / std::abs(twice_area(t)) * (near / far);
    const float share = outside < 0.1f ? 1.5f * outside : 1.0f;
    const float half_cols = 0.5f * static_cast<float>(size_.cols);
    const float half_rows = 0.5f * static_cast<float>(size_.rows);
    const float off_axis =
        pixel_ * (std::max(std::abs(min_x - half_cols), std::abs(max_x - half_cols)) +
                  std::max(std::abs(min_y - half_rows), std::abs(max_y - half_rows)));
    const float extent = pixel_ * size * (near / far) + (near / far - 1.0f) * (1.0f + off_axis);
    return share * kFastest * stretch * extent;
}

bool Cover::hidden(const SpotTriangle& t, float stretch) const {
    const PixelRange cols = pixels_of(t[0].x, t[1].x, t[2].x, size_.cols);
    const PixelRange rows = pixels_of(t[0].y, t[1].y, t[2].y, size_.rows);
    const Walk walk = walk_of(t);
    const float shift_at_edge = shift(t, stretch);
    if (!(shift_at_edge < 0.5f)) return false;
    const float at_edge = (1.0f + kGap) / (1.0f - shift_at_edge);
    for (int row = rows.first; row < rows.end; ++row) {
        const auto [touched, inside] = walk.columns(row, cols);
        const Walk::Slope nearness = walk.nearness(row, -1.0f);
        const float* const cells = nearness_.data() + static_cast<std::ptrdiff_t>(row) * size_.cols;
        for (int col = touched.first; col < touched.end; ++col) {
            // The slope of what has no area is no number: min() then takes the first.
            const float there = std::min(walk.nearest(), nearness.at(col));
            const bool within = col >= inside.first && col < inside.end;
            if (!(cells[col] > there * (within ? 1.0f + kGap : at_edge))) return false;
        }
    }
    return true;
}

}  // namespace raypick
