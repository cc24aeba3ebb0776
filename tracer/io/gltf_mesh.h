// A glTF file's meshes.
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/io/gltf_document.h"

#include <cstddef>
#include <string>
#include <vector>

namespace raypick {

struct GltfMesh {
    Mesh mesh;                // one part a primitive; material ids are indices into /materials
    bool has_lines = false;   // points or lines were passed over
    bool has_morphs = false;  // morph targets were passed over
};

// `uv_sets` says for each of /materials which TEXCOORD_n its parts take. Throws FileError with the
// JSON path.
GltfMesh read_gltf_mesh(GltfDocument& document, std::size_t index, std::string name,
                        const std::vector<int>& uv_sets);

}  // namespace raypick
