// A mesh's arrays on the GPU.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/shapes.h"
#include "viewer/gl/textures.h"

#include <vector>

namespace raypick {

class GpuMesh {
public:
    // Uploads the mesh. A buffer texture gets at most `max_texels` elements; more are spread over
    // several draws.
    GpuMesh(const Mesh& mesh, std::size_t max_texels);

    // True if these are the very arrays and parts of `mesh`. The scene that the mesh was uploaded
    // from must still be alive, so that an address can't have been used again.
    [[nodiscard]] bool holds(const Mesh& mesh) const;
    // The arrays that it was uploaded from.
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    // Bounds of the corners of all triangles, object space.
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
    Mesh mesh_;  // spans and storage
    Bounds bounds_;
    std::vector<Chunk> chunks_;
};

}  // namespace raypick
