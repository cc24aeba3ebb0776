// One reader for each file format; load_scene dispatches to them. Internal to tracer/io.
//
// Each returns a scene in file coordinates (origin 0, transforms and cameras in double) that is not
// checked yet: load_scene calls check_scene and choose_origin once, at the end. Each throws
// FileError (what and where) or Cancelled.
#pragma once

#include "tracer/io/load.h"

#include <filesystem>

namespace raypick {

LoadedScene load_obj(const std::filesystem::path& file, const LoadOptions& options);
LoadedScene load_gltf(const std::filesystem::path& file, const LoadOptions& options);  // and GLB
LoadedScene load_ply(const std::filesystem::path& file, const LoadOptions& options);
LoadedScene load_stl(const std::filesystem::path& file, const LoadOptions& options);
LoadedScene load_nff(const std::filesystem::path& file, const LoadOptions& options);

// Any of the formats above, told apart by content, else by the name's ending.
LoadedScene load_model(const std::filesystem::path& file, const LoadOptions& options);

// Our own JSON scenes; meshes of model files come from load_model.
LoadedScene load_scene_file(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace raypick
