#include "tracer/io/polygon.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raypick {

namespace {

// A polygon that needs this many corners clipped by force crosses itself everywhere, and so does
// one that needs this much work for each corner: the rest is fanned.
constexpr int kMaxForced = 64;
constexpr std::uint64_t kMaxWorkPerCorner = 1000;
constexpr std::uint64_t kLittleWork = 10'000'000;

// Twice the signed area; positive if a, b, c turn counter-clockwise.
double area2(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Newell's method: the normal that suits all corners, its length twice the area.
glm::dvec3 polygon_normal(std::span<const glm::dvec3> corners) {
    glm::dvec3 normal(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    }
    return normal;
}

}  // namespace

std::span<const glm::uvec3> PolygonSplitter::split(std::span<const glm::dvec3> corners) {
    triangles_.clear();
    const auto count = static_cast<std::uint32_t>(corners.size());
    if (count < 3) return triangles_;
    if (count == 3 || !flatten(corners) || fan_is_right()) {
        fan(0, count);
    } else {
        clip_ears();
    }
    return triangles_;
}

void PolygonSplitter::fan(std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first + 1; i + 1 < end; ++i)
        triangles_.emplace_back(first, i, i + 1);
}

bool PolygonSplitter::flatten(std::span<const glm::dvec3> corners) {
    const glm::dvec3 normal = polygon_normal(corners);
    const glm::dvec3 size = glm::abs(normal);
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0.0) || !std::isfinite(largest)) return false;
    const int dropped = size.x == largest ? 0 : size.y == largest ? 1 : 2;
    const int u = (dropped + 1) % 3;
    const int v = (dropped + 2) % 3;
    const bool flipped = normal[dropped] < 0.0;
    flat_.clear();
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 p = corner - corners[0];
        flat_.push_back(flipped ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
    }
    return true;
}

bool PolygonSplitter::fan_is_right() const {
    for (std::size_t i = 1; i + 1 < flat_.size(); ++i) {
        if (area2(flat_[0], flat_[i], flat_[i + 1]) < 0.0) return false;
    }
    return true;
}

void PolygonSplitter::clip_ears() {
    link_corners();
    build_grid();
    auto left = static_cast<std::uint32_t>(flat_.size());
    std::uint32_t corner = 1;
    std::uint32_t tried = 0;
    int forced = 0;
    work_left_ = kLittleWork + kMaxWorkPerCorner * flat_.size();
    while (left > 3 && work_left_ > 0) {
        if (is_ear(corner)) {
            clip(corner);
            --left;
            tried = 0;
            // The corner after next: ears taken all around make rounder triangles than a fan.
            corner = next_[next_[corner]];
        } else if (++tried < left) {
            corner = next_[corner];
        } else if (++forced <= kMaxForced) {
            corner = least_bad(corner);
            clip(corner);
            --left;
            tried = 0;
            corner = next_[corner];
        } else {
            fan_rest(corner);
            return;
        }
    }
    fan_rest(corner);
}

void PolygonSplitter::link_corners() {
    const auto count = static_cast<std::uint32_t>(flat_.size());
    next_.resize(count);
    previous_.resize(count);
    clipped_.assign(count, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        next_[i] = (i + 1) % count;
        previous_[i] = (i + count - 1) % count;
    }
}

void PolygonSplitter::build_grid() {
    glm::dvec2 max = flat_[0];
    grid_min_ = flat_[0];
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < flat_.size(); ++i) {
        grid_min_ = glm::min(grid_min_, flat_[i]);
        max = glm::max(max, flat_[i]);
        if (!(turn(i) > 0.0)) reflex.push_back(i);
    }
    const double wanted = std::sqrt(static_cast<double>(reflex.size()));
    grid_size_ = std::clamp(static_cast<int>(wanted), 1, 1024);
    const glm::dvec2 extent = max - grid_min_;
    for (int axis = 0; axis < 2; ++axis) {
        const double per_unit = grid_size_ / extent[axis];
        cells_per_unit_[axis] = std::isfinite(per_unit) ? per_unit : 0.0;
    }
    // Counting sort by cell.
    const auto index = [&](std::uint32_t corner) {
        const glm::ivec2 at = cell(flat_[corner]);
        return cell_number(at.x, at.y);
    };
    cell_begin_.assign(cell_number(0, grid_size_) + 1, 0);
    for (const std::uint32_t corner : reflex)
        ++cell_begin_[index(corner) + 1];
    for (std::size_t i = 1; i < cell_begin_.size(); ++i)
        cell_begin_[i] += cell_begin_[i - 1];
    std::vector<std::uint32_t> fill(cell_begin_.begin(), cell_begin_.end() - 1);
    cell_corners_.resize(reflex.size());
    for (const std::uint32_t corner : reflex)
        cell_corners_[fill[index(corner)]++] = corner;
}

glm::ivec2 PolygonSplitter::cell(const glm::dvec2& point) const {
    const glm::dvec2 at = (point - grid_min_) * cells_per_unit_;
    return {std::clamp(static_cast<int>(at.x), 0, grid_size_ - 1),
            std::clamp(static_cast<int>(at.y), 0, grid_size_ - 1)};
}

double PolygonSplitter::turn(std::uint32_t corner) const {
    return area2(flat_[previous_[corner]], flat_[corner], flat_[next_[corner]]);
}

bool PolygonSplitter::is_ear(std::uint32_t corner) {
    if (!(turn(corner) > 0.0)) return false;
    const std::uint32_t a = previous_[corner];
    const std::uint32_t c = next_[corner];
    const glm::ivec2 first = cell(glm::min(glm::min(flat_[a], flat_[corner]), flat_[c]));
    const glm::ivec2 last = cell(glm::max(glm::max(flat_[a], flat_[corner]), flat_[c]));
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const std::size_t at = cell_number(x, y);
            const std::uint64_t work = 1 + cell_begin_[at + 1] - cell_begin_[at];
            work_left_ -= std::min(work, work_left_);
            for (std::uint32_t i = cell_begin_[at]; i < cell_begin_[at + 1]; ++i) {
                if (blocks(cell_corners_[i], a, corner, c)) return false;
            }
        }
    }
    return true;
}

bool PolygonSplitter::blocks(std::uint32_t reflex, std::uint32_t a, std::uint32_t b,
                             std::uint32_t c) const {
    if (clipped_[reflex] != 0) return false;
    const glm::dvec2& p = flat_[reflex];
    // Where a hole is bridged, the same point stands at several corners: it blocks nothing.
    if (p == flat_[a] || p == flat_[b] || p == flat_[c]) return false;
    return area2(flat_[a], flat_[b], p) >= 0.0 && area2(flat_[b], flat_[c], p) >= 0.0 &&
           area2(flat_[c], flat_[a], p) >= 0.0;
}

std::uint32_t PolygonSplitter::least_bad(std::uint32_t start) const {
    std::uint32_t best = start;
    double best_turn = -std::numeric_limits<double>::infinity();
    std::uint32_t corner = start;
    do {
        const double t = turn(corner);
        if (t == 0.0) return corner;
        if (t > best_turn) {
            best = corner;
            best_turn = t;
        }
        corner = next_[corner];
    } while (corner != start);
    return best;
}

void PolygonSplitter::clip(std::uint32_t corner) {
    const std::uint32_t a = previous_[corner];
    const std::uint32_t c = next_[corner];
    triangles_.emplace_back(a, corner, c);
    next_[a] = c;
    previous_[c] = a;
    clipped_[corner] = 1;
}

void PolygonSplitter::fan_rest(std::uint32_t start) {
    // `start` may have been clipped: its successor was not.
    const std::uint32_t first = clipped_[start] != 0 ? next_[start] : start;
    for (std::uint32_t i = next_[first]; next_[i] != first; i = next_[i])
        triangles_.emplace_back(first, i, next_[i]);
}

}  // namespace raypick
