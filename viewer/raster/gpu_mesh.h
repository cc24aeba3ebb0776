// A mesh's arrays on the GPU.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/shapes.h"
#include "viewer/gl/textures.h"
#include "viewer/raster/mesh_chunks.h"

#include <memory>
#include <vector>

namespace raypick {

class GpuMesh {
public:
    // Makes room for the mesh, which then has to be filled in, so that many meshes can be on all
    // cores, and finished. A buffer texture gets at most `max_texels` elements; more are spread
    // over several draws.
    GpuMesh(const Mesh& mesh, std::size_t max_texels);
    void fill();  // calls nothing of OpenGL
    void finish();

    // True if these are the very arrays and parts of `mesh`. The scene that the mesh was uploaded
    // from must still be alive, so that an address can't have been used again.
    [[nodiscard]] bool holds(const Mesh& mesh) const;
    // The arrays that it was uploaded from.
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    // Bounds of all vertices, object space.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }

    // One draw: a run of triangles with all that its shader reads.
    struct Chunk {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        BufferTexture triangles;
        BufferTexture positions;
        BufferTexture normals;
        BufferTexture uvs;
        bool has_normals = false;
        bool has_uvs = false;
    };
    [[nodiscard]] const std::vector<Chunk>& chunks() const { return chunks_; }

private:
    // Where a chunk's arrays are mapped; null where it has none.
    struct Mapped {
        MeshChunk run;
        std::byte* triangles = nullptr;
        std::byte* positions = nullptr;
        std::byte* normals = nullptr;
        std::byte* uvs = nullptr;
    };

    void add_chunk(MeshChunk run);

    Mesh mesh_;  // spans and storage
    Bounds bounds_;
    std::vector<Chunk> chunks_;
    std::vector<Mapped> mapped_;  // until they are finished
};

// All three steps.
std::shared_ptr<const GpuMesh> upload_mesh(const Mesh& mesh, std::size_t max_texels);

}  // namespace raypick
