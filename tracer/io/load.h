// Opens any file that we read: our scenes, OBJ, glTF, GLB, PLY, STL, NFF.
#pragma once

#include "tracer/scene/scene.h"

#include <atomic>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace raypick {

struct LoadOptions {
    double crease_degrees = 30.0;  // for meshes without normals; 0: flat
    ObjectId first_object_id = 0;  // ids go on from here, so that a session never reuses one
    std::stop_token stop;          // loading then throws Cancelled
    std::atomic<float>* progress = nullptr;  // 0..1, if wanted
};

struct LoadedScene {
    Scene scene;
    std::vector<std::string> warnings;  // each one line, naming the file and the place
    bool keeps_origin = false;          // scene.origin is the file's: don't choose another
};

// Reads by content where the format says what it is, else by the name's ending. Throws FileError
// (missing, unreadable, empty, malformed: what and where) or Cancelled. The scene passed
// check_scene and has its origin chosen.
LoadedScene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

// The endings that load_scene knows, with the dot, lower case.
std::vector<std::string> readable_extensions();

}  // namespace raypick
