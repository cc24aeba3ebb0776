#include "viewer/raster/mesh_chunks.h"

#include <algorithm>

namespace raypick {

namespace {

// Numbers the vertices of one chunk after the other.
class ChunkBuilder {
public:
    explicit ChunkBuilder(std::size_t vertex_count) : local_(vertex_count, kUnused) {}

    [[nodiscard]] bool fits(const glm::uvec3& triangle, std::size_t max_texels) const {
        std::size_t added = 0;
        for (int i = 0; i < 3; ++i) {
            if (local_[triangle[i]] == kUnused) ++added;
        }
        return chunk_.triangles.size() < max_texels && chunk_.vertices.size() + added <= max_texels;
    }

    void add(const glm::uvec3& triangle) {
        glm::uvec3 renumbered;
        for (int i = 0; i < 3; ++i) {
            std::uint32_t& number = local_[triangle[i]];
            if (number == kUnused) {
                number = static_cast<std::uint32_t>(chunk_.vertices.size());
                chunk_.vertices.push_back(triangle[i]);
            }
            renumbered[i] = number;
        }
        chunk_.triangles.push_back(renumbered);
        ++chunk_.count;
    }

    // The chunk so far; the next one begins after it.
    MeshChunk take() {
        for (const std::uint32_t vertex : chunk_.vertices)
            local_[vertex] = kUnused;
        MeshChunk next;
        next.first = chunk_.first + chunk_.count;
        std::swap(next, chunk_);
        return next;
    }

private:
    static constexpr std::uint32_t kUnused = 0xffffffffu;

    std::vector<std::uint32_t> local_;  // by the mesh's vertex
    MeshChunk chunk_;
};

}  // namespace

std::vector<MeshChunk> split_mesh(std::span<const glm::uvec3> triangles, std::size_t vertex_count,
                                  std::size_t max_texels) {
    std::vector<MeshChunk> chunks;
    if (triangles.empty()) return chunks;
    if (triangles.size() <= max_texels && vertex_count <= max_texels) {
        chunks.push_back({0, static_cast<std::uint32_t>(triangles.size()), {}, {}});
        return chunks;
    }
    ChunkBuilder builder(vertex_count);
    for (const glm::uvec3& triangle : triangles) {
        if (!builder.fits(triangle, max_texels)) chunks.push_back(builder.take());
        builder.add(triangle);
    }
    chunks.push_back(builder.take());
    return chunks;
}

}  // namespace raypick
