// The model files that a scene file refers to: each is read once and shared by all its uses.
#pragma once

#include "tracer/io/load.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

// One of the objects that a model file holds, as it stands there.
struct ModelPiece {
    std::string name;
    std::string path;  // "/axle/wheel"
    Shape shape;
    Transform model_from_object;
    MaterialId material = kNoMaterial;
    Sides sides = Sides::both;
};

class ModelLibrary {
public:
    // Meshes, materials and warnings of the models go to `target`, which must outlive this.
    ModelLibrary(LoadedScene& target, LoadOptions options)
        : target_(&target), options_(std::move(options)) {}

    // For the progress: how many different files will be asked for.
    void expect(std::size_t file_count) { expected_ = file_count; }

    // What the file holds; reads it on the first call. Cameras and lights of a model are left out.
    // Throws FileError or Cancelled.
    const std::vector<ModelPiece>& pieces(const std::filesystem::path& file);

private:
    LoadedScene* target_;
    LoadOptions options_;
    std::size_t expected_ = 1;
    std::map<std::filesystem::path, std::vector<ModelPiece>> models_;
};

}  // namespace raypick
