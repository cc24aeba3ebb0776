#include "viewer/raster/gpu_mesh.h"

#include "viewer/raster/mesh_chunks.h"

#include <glm/vec4.hpp>

#include <algorithm>

namespace raypick {

namespace {

template <typename T>
bool same_array(std::span<const T> a, std::span<const T> b) {
    return a.data() == b.data() && a.size() == b.size();
}

// A texel for each vertex of the chunk, made from the mesh's `values` by `texel`.
template <typename Value, typename TexelOf>
auto chunk_texels(std::span<const Value> values, const MeshChunk& chunk, const TexelOf& texel) {
    std::vector<decltype(texel(values[0]))> result;
    if (chunk.vertices.empty()) {
        result.reserve(values.size());
        for (const Value& value : values)
            result.push_back(texel(value));
    } else {
        result.reserve(chunk.vertices.size());
        for (const std::uint32_t vertex : chunk.vertices)
            result.push_back(texel(values[vertex]));
    }
    return result;
}

// Four floats a vector: three-component buffer textures came with OpenGL 4.0 only.
std::vector<glm::vec4> padded(std::span<const glm::vec3> vectors, const MeshChunk& chunk) {
    return chunk_texels(vectors, chunk, [](const glm::vec3& v) { return glm::vec4(v, 0.0f); });
}

// Three vertices and the material, for each triangle of the chunk.
std::vector<glm::uvec4> with_materials(std::span<const glm::uvec3> triangles,
                                       std::span<const Part> parts, std::uint32_t first) {
    std::vector<glm::uvec4> result;
    result.reserve(triangles.size());
    for (const glm::uvec3& triangle : triangles)
        result.emplace_back(triangle, kNoMaterial);
    for (const Part& part : parts) {
        const auto begin = std::max<std::size_t>(part.first, first);
        const auto end =
            std::min<std::size_t>(std::size_t{part.first} + part.count, first + triangles.size());
        for (std::size_t i = begin; i < end; ++i)
            result[i - first].w = part.material;
    }
    return result;
}

template <typename T>
BufferTexture upload(GLenum internal_format, const std::vector<T>& texels, const char* what) {
    return {internal_format, sizeof(T), std::as_bytes(std::span(texels)), what};
}

GpuMesh::Chunk upload_chunk(const Mesh& mesh, const MeshChunk& run) {
    const std::span<const glm::uvec3> triangles =
        run.triangles.empty() ? mesh.triangles : std::span<const glm::uvec3>(run.triangles);
    GpuMesh::Chunk chunk;
    chunk.first = run.first;
    chunk.count = run.count;
    chunk.has_normals = !mesh.normals.empty();
    chunk.triangles =
        upload(GL_RGBA32UI, with_materials(triangles, mesh.parts, run.first), "triangles");
    chunk.positions = upload(GL_RGBA32F, padded(mesh.positions, run), "vertices");
    if (chunk.has_normals) {
        chunk.normals = upload(GL_RGBA32F, padded(mesh.normals, run), "normals");
    }
    chunk.has_uvs = !mesh.uvs.empty();
    if (chunk.has_uvs) {
        const auto uvs = chunk_texels(mesh.uvs, run, [](const glm::vec2& uv) { return uv; });
        chunk.uvs = upload(GL_RG32F, uvs, "texture coordinates");
    }
    return chunk;
}

}  // namespace

GpuMesh::GpuMesh(const Mesh& mesh, std::size_t max_texels) : mesh_(mesh) {
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            bounds_.extend(mesh.positions[triangle[i]]);
    }
    for (const MeshChunk& run : split_mesh(mesh.triangles, mesh.positions.size(), max_texels)) {
        chunks_.push_back(upload_chunk(mesh, run));
    }
}

bool GpuMesh::holds(const Mesh& mesh) const {
    return same_array(mesh_.positions, mesh.positions) && same_array(mesh_.normals, mesh.normals) &&
           same_array(mesh_.uvs, mesh.uvs) && same_array(mesh_.triangles, mesh.triangles) &&
           mesh_.parts == mesh.parts;
}

}  // namespace raypick
