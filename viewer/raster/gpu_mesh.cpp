#include "viewer/raster/gpu_mesh.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <utility>

namespace raypick {

namespace {

template <typename T>
bool same_array(std::span<const T> a, std::span<const T> b) {
    return a.data() == b.data() && a.size() == b.size();
}

// Writes a texel for each vertex of the run, made from the mesh's `values` by `texel`.
template <typename Value, typename TexelOf>
void write_texels(std::byte* to, std::span<const Value> values, const MeshChunk& run,
                  const TexelOf& texel) {
    auto* texels = reinterpret_cast<decltype(texel(values[0]))*>(to);
    if (run.vertices.empty()) {
        for (const Value& value : values)
            *texels++ = texel(value);
    } else {
        for (const std::uint32_t vertex : run.vertices)
            *texels++ = texel(values[vertex]);
    }
}

// Four floats a vector: three-component buffer textures came with OpenGL 4.0 only.
glm::vec4 padded(const glm::vec3& v) {
    return {v, 0.0f};
}

// Three vertices and the material, for each triangle of the run.
void write_triangles(std::byte* to, std::span<const glm::uvec3> triangles,
                     std::span<const Part> parts, const MeshChunk& run) {
    auto* const texels = reinterpret_cast<glm::uvec4*>(to);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        texels[i] = {triangles[i], kNoMaterial};
    for (const Part& part : parts) {
        const auto begin = std::max<std::size_t>(part.first, run.first);
        const auto end =
            std::min<std::size_t>(std::size_t{part.first} + part.count, run.first + run.count);
        for (std::size_t i = begin; i < end; ++i)
            texels[i - run.first].w = part.material;
    }
}

}  // namespace

GpuMesh::GpuMesh(const Mesh& mesh, std::size_t max_texels) : mesh_(mesh) {
    for (MeshChunk& run : split_mesh(mesh.triangles, mesh.positions.size(), max_texels))
        add_chunk(std::move(run));
}

void GpuMesh::add_chunk(MeshChunk run) {
    const std::size_t vertices =
        run.vertices.empty() ? mesh_.positions.size() : run.vertices.size();
    Chunk chunk;
    Mapped mapped;
    chunk.first = run.first;
    chunk.count = run.count;
    chunk.triangles = {GL_RGBA32UI, sizeof(glm::uvec4), run.count, "triangles"};
    mapped.triangles = chunk.triangles.map();
    chunk.positions = {GL_RGBA32F, sizeof(glm::vec4), vertices, "vertices"};
    mapped.positions = chunk.positions.map();
    chunk.has_normals = !mesh_.normals.empty();
    if (chunk.has_normals) {
        chunk.normals = {GL_RGBA32F, sizeof(glm::vec4), vertices, "normals"};
        mapped.normals = chunk.normals.map();
    }
    chunk.has_uvs = !mesh_.uvs.empty();
    if (chunk.has_uvs) {
        chunk.uvs = {GL_RG32F, sizeof(glm::vec2), vertices, "texture coordinates"};
        mapped.uvs = chunk.uvs.map();
    }
    mapped.run = std::move(run);
    chunks_.push_back(std::move(chunk));
    mapped_.push_back(std::move(mapped));
}

void GpuMesh::fill() {
    for (const glm::vec3& position : mesh_.positions)
        bounds_.extend(position);
    for (const Mapped& to : mapped_) {
        const std::span<const glm::uvec3> triangles =
            to.run.triangles.empty() ? mesh_.triangles : to.run.triangles;
        write_triangles(to.triangles, triangles, mesh_.parts, to.run);
        write_texels(to.positions, mesh_.positions, to.run, padded);
        if (to.normals != nullptr) write_texels(to.normals, mesh_.normals, to.run, padded);
        if (to.uvs == nullptr) continue;
        write_texels(to.uvs, mesh_.uvs, to.run, [](const glm::vec2& uv) { return uv; });
    }
}

void GpuMesh::finish() {
    for (Chunk& chunk : chunks_) {
        chunk.triangles.unmap();
        chunk.positions.unmap();
        if (chunk.has_normals) chunk.normals.unmap();
        if (chunk.has_uvs) chunk.uvs.unmap();
    }
    mapped_.clear();
}

std::shared_ptr<const GpuMesh> upload_mesh(const Mesh& mesh, std::size_t max_texels) {
    auto uploaded = std::make_shared<GpuMesh>(mesh, max_texels);
    uploaded->fill();
    uploaded->finish();
    return uploaded;
}

bool GpuMesh::holds(const Mesh& mesh) const {
    return same_array(mesh_.positions, mesh.positions) && same_array(mesh_.normals, mesh.normals) &&
           same_array(mesh_.uvs, mesh.uvs) && same_array(mesh_.triangles, mesh.triangles) &&
           mesh_.parts == mesh.parts;
}

}  // namespace raypick
