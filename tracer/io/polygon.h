// Polygons into triangles.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// Splits simple polygons, concave ones too, by ear clipping (Meisters 1975, "Polygons Have Ears";
// holes may be bridged by doubled edges). Holds the working memory, so keep it for many polygons.
class PolygonSplitter {
public:
    // Exactly corners.size() - 2 triangles of corner numbers, turning the same way as the polygon,
    // valid until the next call. A fan from the first corner wherever that is right. A polygon
    // that crosses itself gets some triangulation of that many triangles.
    std::span<const glm::uvec3> split(std::span<const glm::dvec3> corners);

private:
    void fan(std::uint32_t first, std::uint32_t end);
    // Projects to the plane that shows the polygon largest, counter-clockwise; false if it has no
    // area there.
    bool flatten(std::span<const glm::dvec3> corners);
    [[nodiscard]] bool fan_is_right() const;

    void clip_ears();
    void link_corners();
    void build_grid();
    [[nodiscard]] double turn(std::uint32_t corner) const;
    [[nodiscard]] bool is_ear(std::uint32_t corner);
    [[nodiscard]] bool blocks(std::uint32_t reflex, std::uint32_t a, std::uint32_t b,
                              std::uint32_t c) const;
    [[nodiscard]] glm::ivec2 cell(const glm::dvec2& point) const;
    [[nodiscard]] std::size_t cell_number(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_size_) +
               static_cast<std::size_t>(x);
    }
    // The corner to clip when no ear is found: a flat one, else the one that sticks out most.
    [[nodiscard]] std::uint32_t least_bad(std::uint32_t start) const;
    void clip(std::uint32_t corner);
    void fan_rest(std::uint32_t start);

    std::vector<glm::uvec3> triangles_;
    std::vector<glm::dvec2> flat_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    std::vector<char> clipped_;

    std::uint64_t work_left_ = 0;  // cells and corners that may still be looked at

    // Only reflex corners can lie in an ear: they stand in a grid of cells.
    std::vector<std::uint32_t> cell_begin_;
    std::vector<std::uint32_t> cell_corners_;
    glm::dvec2 grid_min_{0.0};
    glm::dvec2 cells_per_unit_{0.0};
    int grid_size_ = 1;
};

}  // namespace raypick
