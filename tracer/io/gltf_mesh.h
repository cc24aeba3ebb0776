// A glTF file's meshes.
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/io/gltf_document.h"

#include <cstddef>
#include <string>

namespace raypick {

struct GltfMesh {
    Mesh mesh;                // one part a primitive; material ids are indices into /materials
    bool has_lines = false;   // points or lines were passed over
    bool has_morphs = false;  // morph targets were passed over
};

// Throws FileError with the JSON path.
GltfMesh read_gltf_mesh(GltfDocument& document, std::size_t index, std::string name);

}  // namespace raypick
