// The same triangles as files of several formats.
#pragma once

#include "tracer/geometry/shapes.h"

#include <filesystem>

namespace raypick::bench {

// By the name's ending: .obj (text), .ply, .stl and .glb (binary). Throws std::runtime_error.
void write_model(const MeshData& mesh, const std::filesystem::path& file);

}  // namespace raypick::bench
