#include "tracer/scene/normals.h"

#include "tracer/parallel/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
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
// Triangles or points that one thread takes at a time.
constexpr std::size_t kBlock = 2048;

std::size_t block_count(std::size_t count) {
    return (count + kBlock - 1) / kBlock;
}

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
glm::vec3 face_normal(const MeshData& data, const glm::uvec3& t) {
    const glm::dvec3 a = data.positions[t.x];
    const glm::dvec3 n =
        glm::cross(glm::dvec3(data.positions[t.y]) - a, glm::dvec3(data.positions[t.z]) - a);
    const double length = glm::length(n);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(n / length) : glm::vec3(0.0f);
}

std::vector<glm::vec3> face_normals(const MeshData& data, int threads) {
    std::vector<glm::vec3> normals(data.triangles.size());
    parallel_for(block_count(normals.size()), threads, {}, [&](std::size_t block) {
        const std::size_t end = std::min(normals.size(), (block + 1) * kBlock);
        for (std::size_t t = block * kBlock; t < end; ++t)
            normals[t] = face_normal(data, data.triangles[t]);
    });
    return normals;
}

// What a mesh's smoothing begins with: read by all threads.
struct Corners {
    const MeshData& data;
    const Welded& welded;
    const std::vector<glm::vec3>& face_normals;
    double cos_crease;

    [[nodiscard]] std::uint32_t vertex(Corner c) const {
        return data.triangles[c / 3][static_cast<int>(c % 3)];
    }
    [[nodiscard]] std::uint32_t point(Corner c) const { return welded.point[vertex(c)]; }
    [[nodiscard]] bool degenerate(std::size_t triangle) const {
        return face_normals[triangle] == glm::vec3(0.0f);
    }
    [[nodiscard]] static Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
    [[nodiscard]] static Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }
};

// Smooths the corners at one point after the other; numbers the vertices that it makes from 0.
class PointSmoother {
public:
    PointSmoother(const Corners& mesh, std::vector<glm::uvec3>& new_triangles)
        : mesh_(mesh), new_triangles_(new_triangles) {}

    // All corners at a point; those of degenerate triangles are left out.
    void smooth(std::span<const Corner> corners) {
        spokes_.clear();
        for (std::uint32_t i = 0; i < corners.size(); ++i) {
            const Corner c = corners[i];
            spokes_.push_back(
                {c, mesh_.point(Corners::next(c)), mesh_.point(Corners::previous(c)), i});
        }
        if (spokes_.size() <= kFewCorners) {
            join_all_pairs();
        } else {
            join_along_edges();
        }
        emit_vertices();
    }

    [[nodiscard]] std::uint32_t vertex_count() const {
        return static_cast<std::uint32_t>(out_.positions.size());
    }
    // The vertices, without triangles.
    MeshData take() { return std::move(out_); }

private:
    // What a corner looks like from its point.
    struct Spoke {
        Corner corner = 0;
        std::uint32_t next = 0;  // point after it in its triangle
        std::uint32_t previous = 0;
        std::uint32_t group = 0;  // union-find: index of another spoke of its group
    };

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
        const glm::dvec3 a = mesh_.face_normals[spokes_[i].corner / 3];
        const glm::dvec3 b = mesh_.face_normals[spokes_[j].corner / 3];
        if (!(glm::dot(a, b) > mesh_.cos_crease)) return;
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
        if (mesh_.data.uvs.empty()) return 0;
        const glm::vec2& uv = mesh_.data.uvs[mesh_.vertex(c)];
        return (static_cast<std::uint64_t>(bits(uv.x)) << 32u) | bits(uv.y);
    }

    // Times the area and the angle at the corner (Thürmer and Wüthrich 1998, "Computing Vertex
    // Normals from Polygonal Facets", for the angle).
    [[nodiscard]] glm::dvec3 weighted_normal(Corner c) const {
        const glm::dvec3 p = mesh_.data.positions[mesh_.vertex(c)];
        const glm::dvec3 to_next =
            glm::dvec3(mesh_.data.positions[mesh_.vertex(Corners::next(c))]) - p;
        const glm::dvec3 to_previous =
            glm::dvec3(mesh_.data.positions[mesh_.vertex(Corners::previous(c))]) - p;
        const glm::dvec3 cross = glm::cross(to_next, to_previous);
        return cross * std::atan2(glm::length(cross), glm::dot(to_next, to_previous));
    }

    [[nodiscard]] glm::vec3 group_normal(std::uint32_t group) const {
        const double length = glm::length(sums_[group]);
        const bool good = length > 0.0 && std::isfinite(length);
        return good ? glm::vec3(sums_[group] / length)
                    : mesh_.face_normals[spokes_[group].corner / 3];
    }

    void add_vertex(Corner from, const glm::vec3& normal) {
        out_.positions.push_back(mesh_.data.positions[mesh_.vertex(from)]);
        out_.normals.push_back(normal);
        if (!mesh_.data.uvs.empty()) out_.uvs.push_back(mesh_.data.uvs[mesh_.vertex(from)]);
    }

    void set_corner(Corner c, std::uint32_t new_vertex) {
        new_triangles_[c / 3][static_cast<int>(c % 3)] = new_vertex;
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

    const Corners& mesh_;
    std::vector<glm::uvec3>& new_triangles_;
    MeshData out_;

    // Of the point at hand.
    std::vector<Spoke> spokes_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;  // point across, spoke
    std::vector<glm::dvec3> sums_;                                // of a group, at its first spoke
    std::vector<Use> uses_;
};

class Smoother {
public:
    Smoother(MeshData data, double crease_degrees, int threads)
        : data_(std::move(data)),
          welded_(weld(data_.positions)),
          face_normals_(face_normals(data_, threads)),
          mesh_{data_, welded_, face_normals_,
                crease_degrees < 180.0 ? std::cos(crease_degrees * M_PI / 180.0) : -2.0},
          new_triangles_(data_.triangles.size()),
          threads_(threads) {}

    MeshData smooth() {
        sort_corners_by_point();
        smooth_blocks();
        join_blocks();
        place_degenerate();
        out_.triangles = std::move(new_triangles_);
        return std::move(out_);
    }

private:
    // Points [first, end) and what has become of them. A block's vertices are numbered from 0.
    struct Block {
        std::uint32_t first = 0;
        std::uint32_t end = 0;
        std::uint32_t first_vertex = 0;  // of all blocks'
        MeshData vertices;
    };

    // Counting sort; degenerate triangles are left out.
    void sort_corners_by_point() {
        begin_.assign(static_cast<std::size_t>(welded_.count) + 1, 0);
        const auto count = static_cast<Corner>(3 * data_.triangles.size());
        for (Corner c = 0; c < count; ++c) {
            if (!mesh_.degenerate(c / 3)) ++begin_[mesh_.point(c) + 1];
        }
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        std::vector<std::uint32_t> fill(begin_.begin(), begin_.end() - 1);
        corners_.resize(begin_.back());
        for (Corner c = 0; c < count; ++c) {
            if (!mesh_.degenerate(c / 3)) corners_[fill[mesh_.point(c)]++] = c;
        }
        first_vertex_.assign(welded_.count, kNone);
    }

    // No two threads meet: a corner belongs to one point.
    void smooth_blocks() {
        blocks_.resize(block_count(welded_.count));
        parallel_for(blocks_.size(), threads_, {}, [&](std::size_t i) {
            Block& block = blocks_[i];
            block.first = static_cast<std::uint32_t>(i * kBlock);
            block.end = std::min(welded_.count, static_cast<std::uint32_t>((i + 1) * kBlock));
            PointSmoother smoother(mesh_, new_triangles_);
            for (std::uint32_t point = block.first; point < block.end; ++point) {
                const std::uint32_t count = begin_[point + 1] - begin_[point];
                if (count == 0) continue;
                first_vertex_[point] = smoother.vertex_count();
                smoother.smooth({&corners_[begin_[point]], count});
            }
            block.vertices = smoother.take();
        });
    }

    // One block's vertices behind the other's, as if they had been made in turn.
    void join_blocks() {
        if (blocks_.size() == 1) {
            out_ = std::move(blocks_[0].vertices);
            return;
        }
        std::uint32_t count = 0;
        for (Block& block : blocks_) {
            block.first_vertex = count;
            count += static_cast<std::uint32_t>(block.vertices.positions.size());
        }
        out_.positions.resize(count);
        out_.normals.resize(count);
        if (!data_.uvs.empty()) out_.uvs.resize(count);
        parallel_for(blocks_.size(), threads_, {}, [&](std::size_t i) { place(blocks_[i]); });
        blocks_.clear();
    }

    void place(Block& block) {
        const auto to = static_cast<std::ptrdiff_t>(block.first_vertex);
        std::ranges::copy(block.vertices.positions, out_.positions.begin() + to);
        std::ranges::copy(block.vertices.normals, out_.normals.begin() + to);
        std::ranges::copy(block.vertices.uvs, out_.uvs.begin() + to);
        block.vertices = {};
        if (block.first_vertex == 0) return;
        for (std::uint32_t i = begin_[block.first]; i < begin_[block.end]; ++i)
            new_triangles_[corners_[i] / 3][static_cast<int>(corners_[i] % 3)] +=
                block.first_vertex;
        for (std::uint32_t point = block.first; point < block.end; ++point) {
            if (first_vertex_[point] != kNone) first_vertex_[point] += block.first_vertex;
        }
    }

    // Degenerate triangles use whatever vertex stands at their corners.
    void place_degenerate() {
        for (std::size_t t = 0; t < data_.triangles.size(); ++t) {
            if (!mesh_.degenerate(t)) continue;
            for (auto c = static_cast<Corner>(3 * t); c < 3 * t + 3; ++c) {
                std::uint32_t& first = first_vertex_[mesh_.point(c)];
                if (first == kNone) {
                    first = static_cast<std::uint32_t>(out_.positions.size());
                    add_lone_vertex(c);
                }
                new_triangles_[t][static_cast<int>(c % 3)] = first;
            }
        }
    }

    void add_lone_vertex(Corner c) {
        const std::uint32_t from = mesh_.vertex(c);
        const glm::vec3 position = data_.positions[from];
        out_.positions.push_back(position);
        out_.normals.emplace_back(0.0f, 0.0f, 1.0f);
        if (!data_.uvs.empty()) out_.uvs.push_back(data_.uvs[from]);
    }

    MeshData data_;
    Welded welded_;
    std::vector<glm::vec3> face_normals_;
    Corners mesh_;
    std::vector<glm::uvec3> new_triangles_;
    int threads_;
    std::vector<std::uint32_t> begin_;  // of each point's corners in `corners_`
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> first_vertex_;  // of each point in `out_`
    std::vector<Block> blocks_;
    MeshData out_;
};

}  // namespace

MeshData with_crease_normals(MeshData data, double crease_degrees, int threads) {
    data.normals.clear();
    if (!(crease_degrees > 0.0)) return data;
    return Smoother(std::move(data), crease_degrees, threads).smooth();
}

}  // namespace raypick
