// Cuts meshes to what buffer textures can hold.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// A run of a mesh's triangles. OpenGL 3.3 promises only 65536 texels to a buffer texture; most
// give far more, and then a mesh is one chunk that uses the mesh's own arrays.
struct MeshChunk {
    std::uint32_t first = 0;  // triangle of the mesh
    std::uint32_t count = 0;
    // The mesh's vertices that the chunk uses, and its triangles over these. Empty if the chunk is
    // the whole mesh.
    std::vector<std::uint32_t> vertices;
    std::vector<glm::uvec3> triangles;
};

// In the order of the triangles, each with at most `max_texels` triangles and vertices (at least
// 3).
std::vector<MeshChunk> split_mesh(std::span<const glm::uvec3> triangles, std::size_t vertex_count,
                                  std::size_t max_texels);

}  // namespace raypick
