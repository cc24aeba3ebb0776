#include "tracer/io/model_library.h"

#include "tracer/io/formats.h"

#include <iterator>
#include <utility>

namespace raypick {

namespace {

MaterialId moved(MaterialId id, MaterialId offset) {
    return id == kNoMaterial ? kNoMaterial : id + offset;
}

// Moves meshes, materials and warnings of `model` to the end of `target`'s; returns its objects
// with ids that hold there.
std::vector<ModelPiece> append(LoadedScene& target, LoadedScene model) {
    const auto mesh_offset = static_cast<MeshId>(target.scene.meshes.size());
    const auto material_offset = static_cast<MaterialId>(target.scene.materials.size());
    for (Material& material : model.scene.materials) {
        target.scene.materials.push_back(std::move(material));
    }
    for (Mesh& mesh : model.scene.meshes) {
        for (Part& part : mesh.parts)
            part.material = moved(part.material, material_offset);
        target.scene.meshes.push_back(std::move(mesh));
    }
    std::move(model.warnings.begin(), model.warnings.end(), std::back_inserter(target.warnings));

    std::vector<ModelPiece> pieces;
    pieces.reserve(model.scene.objects.size());
    for (Object& object : model.scene.objects) {
        if (MeshInstance* instance = std::get_if<MeshInstance>(&object.shape)) {
            instance->mesh += mesh_offset;
        }
        pieces.push_back({std::move(object.name), std::move(object.path), object.shape,
                          object.world_from_object, moved(object.material, material_offset)});
    }
    return pieces;
}

}  // namespace

const std::vector<ModelPiece>& ModelLibrary::pieces(const std::filesystem::path& file) {
    std::error_code ignored;
    std::filesystem::path key = std::filesystem::weakly_canonical(file, ignored);
    if (key.empty()) key = file;
    if (const auto known = models_.find(key); known != models_.end()) return known->second;

    LoadOptions options = options_;
    options.first_object_id = 0;
    // A reader reports from 0 to 1; with many files each is one step instead.
    if (expected_ > 1) options.progress = nullptr;
    std::vector<ModelPiece> pieces = append(*target_, load_model(file, options));
    const std::vector<ModelPiece>& stored =
        models_.emplace(std::move(key), std::move(pieces)).first->second;
    if (options_.progress != nullptr && expected_ > 1) {
        *options_.progress = static_cast<float>(models_.size()) / static_cast<float>(expected_);
    }
    return stored;
}

}  // namespace raypick
