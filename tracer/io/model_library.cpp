#include "tracer/io/model_library.h"

#include "tracer/io/formats.h"

#include <iterator>
#include <utility>

namespace raypick {

namespace {

MaterialId moved(MaterialId id, MaterialId offset) {
    return id == kNoMaterial ? kNoMaterial : id + offset;
}

// Where a model's things come to stand behind those that a scene has.
struct Offsets {
    MeshId mesh = 0;
    SetId sphere_set = 0;
    SetId cone_set = 0;
    MaterialId material = 0;
    TextureId texture = 0;
};

Offsets offsets_in(const Scene& scene) {
    return {static_cast<MeshId>(scene.meshes.size()), static_cast<SetId>(scene.sphere_sets.size()),
            static_cast<SetId>(scene.cone_sets.size()),
            static_cast<MaterialId>(scene.materials.size()),
            static_cast<TextureId>(scene.textures.size())};
}

// Meshes and sets go to the end of the target's.
template <typename Thing>
void append_with_parts(std::vector<Thing>& target, std::vector<Thing>& things, MaterialId offset) {
    for (Thing& thing : things) {
        for (Part& part : thing.parts)
            part.material = moved(part.material, offset);
        target.push_back(std::move(thing));
    }
}

void append_materials(Scene& target, Scene& model, const Offsets& offsets) {
    std::move(model.textures.begin(), model.textures.end(), std::back_inserter(target.textures));
    for (Material& material : model.materials) {
        for (TextureMap& map : material.maps) {
            if (map) map.texture += offsets.texture;
        }
        target.materials.push_back(std::move(material));
    }
}

Shape moved(Shape shape, const Offsets& offsets) {
    if (auto* mesh = std::get_if<MeshInstance>(&shape)) mesh->mesh += offsets.mesh;
    if (auto* spheres = std::get_if<SphereSetInstance>(&shape)) spheres->set += offsets.sphere_set;
    if (auto* cones = std::get_if<ConeSetInstance>(&shape)) cones->set += offsets.cone_set;
    return shape;
}

// Moves what `model` consists of to the end of `target`'s; returns its objects with ids that hold
// there.
std::vector<ModelPiece> append(LoadedScene& target, LoadedScene model) {
    const Offsets offsets = offsets_in(target.scene);
    append_materials(target.scene, model.scene, offsets);
    append_with_parts(target.scene.meshes, model.scene.meshes, offsets.material);
    append_with_parts(target.scene.sphere_sets, model.scene.sphere_sets, offsets.material);
    append_with_parts(target.scene.cone_sets, model.scene.cone_sets, offsets.material);
    std::move(model.warnings.begin(), model.warnings.end(), std::back_inserter(target.warnings));

    std::vector<ModelPiece> pieces;
    pieces.reserve(model.scene.objects.size());
    for (Object& object : model.scene.objects) {
        pieces.push_back({std::move(object.name), std::move(object.path),
                          moved(object.shape, offsets), object.world_from_object,
                          moved(object.material, offsets.material), object.sides});
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
