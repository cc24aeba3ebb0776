#include "viewer/raster/cover.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <optional>

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

// The line through two corners: a dx + b dy + c is 0 there and above 0 inside, where dx and dy
// count from the triangle's first corner.
struct Edge {
    float a = 0.0f;
    float b = 0.0f;
    float c = 0.0f;
    float margin = 0.0f;  // this is what a move by kSpotMargin changes at most

    Edge(const Spot& from, const Spot& to, const Spot& origin)
        : a(from.y - to.y),
          b(to.x - from.x),
          c(-a * (from.x - origin.x) - b * (from.y - origin.y)),
          margin(kSpotMargin * (std::abs(a) + std::abs(b))) {}
};

// Columns of a row.
struct Columns {
    PixelRange touched;  // their centres may be inside
    PixelRange inside;   // they are for sure
};

// A triangle at work on rows of pixels.
class Walk {
public:
    // The corners in the turn that has the inside above 0.
    explicit Walk(const SpotTriangle& t)
        : edges_{Edge(t[0], t[1], t[0]), Edge(t[1], t[2], t[0]), Edge(t[2], t[0], t[0])},
          origin_(t[0]) {}

    [[nodiscard]] Columns columns(int row, const PixelRange& within) const {
        const float dy = static_cast<float>(row) + 0.5f - origin_.y;
        return within.end - within.first <= kFewColumns ? few_columns(dy, within)
                                                        : many_columns(dy, within);
    }

private:
    static constexpr int kFewColumns = 4;

    // Asks each pixel.
    [[nodiscard]] Columns few_columns(float dy, const PixelRange& within) const {
        Columns columns{{within.end, within.first}, {within.end, within.first}};
        for (int col = within.first; col < within.end; ++col) {
            const float dx = static_cast<float>(col) + 0.5f - origin_.x;
            float least_outside = 0.0f;  // below 0: too far outside of some edge
            float least_inside = 0.0f;
            for (const Edge& edge : edges_) {
                const float value = edge.a * dx + edge.b * dy + edge.c;
                least_outside = std::min(least_outside, value + edge.margin);
                least_inside = std::min(least_inside, value - edge.margin);
            }
            if (least_outside >= 0.0f) widen(columns.touched, col);
            if (least_inside >= 0.0f) widen(columns.inside, col);
        }
        return columns;
    }

    static void widen(PixelRange& range, int col) {
        range.first = std::min(range.first, col);
        range.end = std::max(range.end, col + 1);
    }

    // Asks the edges where they cross the row.
    [[nodiscard]] Columns many_columns(float dy, const PixelRange& within) const {
        constexpr float kLeast = 1e-15f;  // keeps the quotient finite where the line is level
        float low = -1e9f;
        float high = 1e9f;
        float low_inside = low;
        float high_inside = high;
        for (const Edge& edge : edges_) {
            const float a = std::abs(edge.a) > kLeast ? edge.a : kLeast;
            const float at = -(edge.b * dy + edge.c) / a;
            const float margin = edge.margin / std::abs(a);
            if (a > 0.0f) {
                low = std::max(low, at - margin);
                low_inside = std::max(low_inside, at + margin);
            } else {
                high = std::min(high, at + margin);
                high_inside = std::min(high_inside, at - margin);
            }
        }
        const float x = origin_.x;
        return {{pixel_beyond(x + low, within), pixel_beyond(x + high, within)},
                {pixel_beyond(x + low_inside, within), pixel_beyond(x + high_inside, within)}};
    }

    std::array<Edge, 3> edges_;
    Spot origin_;
};

// Twice the triangle's, with the sign of its turn.
float twice_area(const SpotTriangle& t) {
    return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

SpotTriangle turned_left(const SpotTriangle& t) {
    return twice_area(t) < 0.0f ? SpotTriangle{t[0], t[2], t[1]} : t;
}

float least(float a, float b, float c) {
    return std::min(std::min(a, b), c);
}
float greatest(float a, float b, float c) {
    return std::max(std::max(a, b), c);
}

// The pixels that a triangle may take.
struct PixelBox {
    PixelRange cols;
    PixelRange rows;
};
PixelBox pixel_box(const SpotTriangle& t, ImageSize size) {
    const PixelRange cols{0, size.cols};
    const PixelRange rows{0, size.rows};
    return {{pixel_beyond(least(t[0].x, t[1].x, t[2].x) - kSpotMargin, cols),
             pixel_beyond(greatest(t[0].x, t[1].x, t[2].x) + kSpotMargin, cols)},
            {pixel_beyond(least(t[0].y, t[1].y, t[2].y) - kSpotMargin, rows),
             pixel_beyond(greatest(t[0].y, t[1].y, t[2].y) + kSpotMargin, rows)}};
}

// Nearness over the image, which is linear there. Where the triangle is steep it is known less
// well: `side` 1 gives the least that it may be, -1 the greatest.
class NearnessPlane {
public:
    NearnessPlane(const SpotTriangle& t, float side) : origin_(t[0]) {
        const float n1 = t[1].nearness - t[0].nearness;
        const float n2 = t[2].nearness - t[0].nearness;
        const float per_area = 1.0f / twice_area(t);
        by_x_ = (n1 * (t[2].y - t[0].y) - n2 * (t[1].y - t[0].y)) * per_area;
        by_y_ = (n2 * (t[1].x - t[0].x) - n1 * (t[2].x - t[0].x)) * per_area;
        origin_.nearness -= side * kSpotMargin * (std::abs(by_x_) + std::abs(by_y_));
    }

    // At the centre of a row's column 0, and how it grows by column.
    struct Slope {
        float at_0 = 0.0f;
        float by_col = 0.0f;

        [[nodiscard]] float at(int col) const { return at_0 + by_col * static_cast<float>(col); }
    };
    [[nodiscard]] Slope in_row(int row) const {
        const float dy = static_cast<float>(row) + 0.5f - origin_.y;
        return {origin_.nearness + by_y_ * dy + by_x_ * (0.5f - origin_.x), by_x_};
    }

private:
    Spot origin_;
    float by_x_ = 0.0f;
    float by_y_ = 0.0f;
};

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

bool Cover::add(const SpotTriangle& triangle, bool hides) {
    const PixelBox box = pixel_box(triangle, size_);
    if (box.cols.empty() || box.rows.empty()) return false;
    const SpotTriangle t = turned_left(triangle);
    const Walk walk(t);
    std::optional<NearnessPlane> plane;
    bool takes_pixels = false;
    for (int row = box.rows.first; row < box.rows.end; ++row) {
        const auto [touched, inside] = walk.columns(row, box.cols);
        takes_pixels = takes_pixels || !touched.empty();
        if (!hides || inside.empty()) continue;
        if (!plane) plane.emplace(t, 1.0f);
        const NearnessPlane::Slope nearness = plane->in_row(row);
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
    const float min_x = least(t[0].x, t[1].x, t[2].x);
    const float max_x = greatest(t[0].x, t[1].x, t[2].x);
    const float min_y = least(t[0].y, t[1].y, t[2].y);
    const float max_y = greatest(t[0].y, t[1].y, t[2].y);
    const float far = least(t[0].nearness, t[1].nearness, t[2].nearness);
    const float near = greatest(t[0].nearness, t[1].nearness, t[2].nearness);
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

bool Cover::hidden(const SpotTriangle& triangle, float stretch) const {
    const float shift_at_edge = shift(triangle, stretch);
    if (!(shift_at_edge < 0.5f)) return false;
    const float at_edge = (1.0f + kGap) / (1.0f - shift_at_edge);
    const PixelBox box = pixel_box(triangle, size_);
    const SpotTriangle t = turned_left(triangle);
    const Walk walk(t);
    const NearnessPlane plane(t, -1.0f);
    const float nearest = greatest(t[0].nearness, t[1].nearness, t[2].nearness);
    for (int row = box.rows.first; row < box.rows.end; ++row) {
        const auto [touched, inside] = walk.columns(row, box.cols);
        const NearnessPlane::Slope nearness = plane.in_row(row);
        const float* const cells = nearness_.data() + static_cast<std::ptrdiff_t>(row) * size_.cols;
        for (int col = touched.first; col < touched.end; ++col) {
            // The slope of what has no area is no number: min() then takes the first.
            const float there = std::min(nearest, nearness.at(col));
            const bool within = col >= inside.first && col < inside.end;
            if (!(cells[col] > there * (within ? 1.0f + kGap : at_edge))) return false;
        }
    }
    return true;
}

}  // namespace raypick
