#include "tracer/scene/normals.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace raypick {

namespace {

// A corner of a triangle: 3 * triangle + 0, 1 or 2.
using Corner = std::uint32_t;

constexpr std::uint32_t kNone = 0xffffffffu;

// An edge with more faces than this is no surface any more; each face is compared with this many
// of the next ones only, so that hostile files cost no quadratic time.
constexpr std::size_t kMaxFacesAtEdge = 16;
// Corners at one point up to which comparing all pairs beats sorting their edges.
constexpr std::size_t kFewCorners = 16;

std::uint32_t bits(float x) {
    return std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 becomes +0
}

struct PositionKey {
    std::uint32_t x, y, z;

    explicit PositionKey(const glm::vec3& p) : x(bits(p.x)), y(bits(p.y)), z(bits(p.z)) {}
    friend bool operator==(const PositionKey&, const PositionKey&) = default;

    [[nodiscard]] std::uint64_t hash() const {
        std::uint64_t h = x * 0x9e3779b97f4a7c15u;
        h = (h ^ (h >> 29u) ^ y) * 0xbf58476d1ce4e5b9u;
        h = (h ^ (h >> 32u) ^ z) * 0x94d049bb133111ebu;
        return h ^ (h >> 31u);
    }
};

// Numbers that tell equal positions apart, 0, 1, 2, ... in order of appearance.
struct Welded {
    std::vector<std::uint32_t> point;  // of each vertex
    std::uint32_t count = 0;
};

Welded weld(const std::vector<glm::vec3>& positions) {
    Welded welded;
    welded.point.resize(positions.size());
    // Open addressing; the table holds the first vertex of each point.
    std::vector<std::uint32_t> table(std::bit_ceil(2 * positions.size() + 1), kNone);
    const std::size_t mask = table.size() - 1;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const PositionKey key(positions[i]);
        std::size_t slot = key.hash() & mask;
        while (table[slot] != kNone && PositionKey(positions[table[slot]]) != key)
            slot = (slot + 1) & mask;
        if (table[slot] == kNone) {
            table[slot] = i;
            welded.point[i] = welded.count++;
        } else {
            welded.point[i] = welded.point[table[slot]];
        }
    }
    return welded;
}

// Unit normals; 0 for degenerate triangles.
std::vector<glm::vec3> face_normals(const MeshData& data) {
    std::vector<glm::vec3> normals;
    normals.reserve(data.triangles.size());
    for (const glm::uvec3& t : data.triangles) {
        const glm::dvec3 a = data.positions[t.x];
        const glm::dvec3 n =
            glm::cross(glm::dvec3(data.positions[t.y]) - a, glm::dvec3(data.positions[t.z]) - a);
        const double length = glm::length(n);
        normals.push_back(length > 0.0 && std::isfinite(length) ? glm::vec3(n / length)
                                                                : glm::vec3(0.0f));
    }
    return normals;
}

class Smoother {
public:
    Smoother(MeshData data, double crease_degrees)
        : data_(std::move(data)),
          cos_crease_(crease_degrees < 180.0 ? std::cos(crease_degrees * M_PI / 180.0) : -2.0),
          welded_(weld(data_.positions)),
          face_normals_(face_normals(data_)),
          new_triangles_(data_.triangles.size()) {}

    MeshData smooth() {
        sort_corners_by_point();
        for (std::uint32_t point = 0; point < welded_.count; ++point)
            smooth_point(point);
        place_degenerate();
        out_.triangles = std::move(new_triangles_);
        return std::move(out_);
    }

private:
    // What a corner looks like from its point.
    struct Spoke {
        Corner corner = 0;
        std::uint32_t next = 0;  // point after it in its triangle
        std::uint32_t previous = 0;
        std::uint32_t group = 0;  // union-find: index of another spoke of its group
    };

    [[nodiscard]] std::uint32_t vertex(Corner c) const {
        return data_.triangles[c / 3][static_cast<int>(c % 3)];
    }
    [[nodiscard]] static Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
    [[nodiscard]] static Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }
    [[nodiscard]] bool degenerate(std::size_t triangle) const {
        return face_normals_[triangle] == glm::vec3(0.0f);
    }

    // Counting sort; degenerate triangles are left out.
    void sort_corners_by_point() {
        begin_.assign(static_cast<std::size_t>(welded_.count) + 1, 0);
        const auto count = static_cast<Corner>(3 * data_.triangles.size());
        for (Corner c = 0; c < count; ++c) {
            if (!degenerate(c / 3)) ++begin_[welded_.point[vertex(c)] + 1];
        }
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        std::vector<std::uint32_t> fill(begin_.begin(), begin_.end() - 1);
        corners_.resize(begin_.back());
        for (Corner c = 0; c < count; ++c) {
            if (!degenerate(c / 3)) corners_[fill[welded_.point[vertex(c)]]++] = c;
        }
        first_vertex_.assign(welded_.count, kNone);
    }

    void smooth_point(std::uint32_t point) {
        spokes_.clear();
        for (std::uint32_t i = begin_[point]; i < begin_[point + 1]; ++i) {
            const Corner c = corners_[i];
            spokes_.push_back({c, welded_.point[vertex(next(c))],
                               welded_.point[vertex(previous(c))], i - begin_[point]});
        }
        if (spokes_.empty()) return;
        if (spokes_.size() <= kFewCorners) {
            join_all_pairs();
        } else {
            join_along_edges();
        }
        first_vertex_[point] = static_cast<std::uint32_t>(out_.positions.size());
        emit_vertices();
    }

    void join_all_pairs() {
        for (std::uint32_t i = 0; i < spokes_.size(); ++i) {
            for (std::uint32_t j = i + 1; j < spokes_.size(); ++j) {
                const Spoke& a = spokes_[i];
                const Spoke& b = spokes_[j];
                const bool share_edge = a.next == b.previous || a.previous == b.next ||
                                        a.next == b.next || a.previous == b.previous;
                if (share_edge) join_if_smooth(i, j);
            }
        }
    }

    void join_along_edges() {
        edges_.clear();
        for (std::uint32_t i = 0; i < spokes_.size(); ++i) {
            edges_.emplace_back(spokes_[i].next, i);
            edges_.emplace_back(spokes_[i].previous, i);
        }
        std::sort(edges_.begin(), edges_.end());
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            const std::size_t end = std::min(edges_.size(), i + 1 + kMaxFacesAtEdge);
            for (std::size_t j = i + 1; j < end && edges_[j].first == edges_[i].first; ++j)
                join_if_smooth(edges_[i].second, edges_[j].second);
        }
    }

    void join_if_smooth(std::uint32_t i, std::uint32_t j) {
        const glm::dvec3 a = face_normals_[spokes_[i].corner / 3];
        const glm::dvec3 b = face_normals_[spokes_[j].corner / 3];
        if (!(glm::dot(a, b) > cos_crease_)) return;
        const std::uint32_t root_i = root(i);
        const std::uint32_t root_j = root(j);
        spokes_[std::max(root_i, root_j)].group = std::min(root_i, root_j);
    }

    // The first spoke of the group.
    std::uint32_t root(std::uint32_t i) {
        while (spokes_[i].group != i) {
            spokes_[i].group = spokes_[spokes_[i].group].group;
            i = spokes_[i].group;
        }
        return i;
    }

    // One vertex for each group, or for each pair of group and uv.
    void emit_vertices() {
        sums_.assign(spokes_.size(), glm::dvec3(0.0));
        uses_.clear();
        for (std::uint32_t i = 0; i < spokes_.size(); ++i) {
            const std::uint32_t group = root(i);
            sums_[group] += weighted_normal(spokes_[i].corner);
            uses_.push_back({group, uv_key(spokes_[i].corner), spokes_[i].corner});
        }
        std::sort(uses_.begin(), uses_.end());
        for (std::size_t i = 0; i < uses_.size(); ++i) {
            const bool same =
                i > 0 && uses_[i - 1].group == uses_[i].group && uses_[i - 1].uv == uses_[i].uv;
            if (!same) add_vertex(uses_[i].corner, group_normal(uses_[i].group));
            set_corner(uses_[i].corner, static_cast<std::uint32_t>(out_.positions.size() - 1));
        }
    }

    [[nodiscard]] std::uint64_t uv_key(Corner c) const {
        if (data_.uvs.empty()) return 0;
        const glm::vec2& uv = data_.uvs[vertex(c)];
        return (static_cast<std::uint64_t>(bits(uv.x)) << 32u) | bits(uv.y);
    }

    // Times the area and the angle at the corner (Thürmer and Wüthrich 1998, "Computing Vertex
    // Normals from Polygonal Facets", for the angle).
    [[nodiscard]] glm::dvec3 weighted_normal(Corner c) const {
        const glm::dvec3 p = data_.positions[vertex(c)];
        const glm::dvec3 to_next = glm::dvec3(data_.positions[vertex(next(c))]) - p;
        const glm::dvec3 to_previous = glm::dvec3(data_.positions[vertex(previous(c))]) - p;
        const glm::dvec3 cross = glm::cross(to_next, to_previous);
        return cross * std::atan2(glm::length(cross), glm::dot(to_next, to_previous));
    }

    [[nodiscard]] glm::vec3 group_normal(std::uint32_t group) const {
        const double length = glm::length(sums_[group]);
        const bool good = length > 0.0 && std::isfinite(length);
        return good ? glm::vec3(sums_[group] / length) : face_normals_[spokes_[group].corner / 3];
    }

    void add_vertex(Corner from, const glm::vec3& normal) {
        out_.positions.push_back(data_.positions[vertex(from)]);
        out_.normals.push_back(normal);
        if (!data_.uvs.empty()) out_.uvs.push_back(data_.uvs[vertex(from)]);
    }

    void set_corner(Corner c, std::uint32_t new_vertex) {
        new_triangles_[c / 3][static_cast<int>(c % 3)] = new_vertex;
    }

    // Degenerate triangles use whatever vertex stands at their corners.
    void place_degenerate() {
        for (std::size_t t = 0; t < data_.triangles.size(); ++t) {
            if (!degenerate(t)) continue;
            for (auto c = static_cast<Corner>(3 * t); c < 3 * t + 3; ++c) {
                std::uint32_t& first = first_vertex_[welded_.point[vertex(c)]];
                if (first == kNone) {
                    first = static_cast<std::uint32_t>(out_.positions.size());
                    add_vertex(c, glm::vec3(0.0f, 0.0f, 1.0f));
                }
                set_corner(c, first);
            }
        }
    }

    // Corners that share a vertex after smoothing.
    struct Use {
        std::uint32_t group = 0;
        std::uint64_t uv = 0;
        Corner corner = 0;

        friend bool operator<(const Use& a, const Use& b) {
            return std::tie(a.group, a.uv, a.corner) < std::tie(b.group, b.uv, b.corner);
        }
    };

    MeshData data_;
    double cos_crease_;
    Welded welded_;
    std::vector<glm::vec3> face_normals_;
    std::vector<glm::uvec3> new_triangles_;
    std::vector<std::uint32_t> begin_;  // of each point's corners in `corners_`
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> first_vertex_;  // of each point in `out_`
    MeshData out_;

    // Of the point at hand.
    std::vector<Spoke> spokes_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;  // point across, spoke
    std::vector<glm::dvec3> sums_;                                // of a group, at its first spoke
    std::vector<Use> uses_;
};

}  // namespace

MeshData with_crease_normals(MeshData data, double crease_degrees) {
    data.normals.clear();
    if (!(crease_degrees > 0.0)) return data;
    return Smoother(std::move(data), crease_degrees).smooth();
}

}  // namespace raypick
