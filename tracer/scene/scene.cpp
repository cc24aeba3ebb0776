#include "tracer/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace raypick {

namespace {

std::string unique_name(Scene& scene, std::string name) {
    if (name.empty()) name = "object";
    const auto [entry, is_new] = scene.used_names.try_emplace(name, 1u);
    if (is_new) return name;
    // References into the map survive its growth, iterators do not.
    std::uint32_t& last_number = entry->second;
    while (true) {
        std::string numbered = fmt::format("{}#{}", name, ++last_number);
        if (scene.used_names.try_emplace(numbered, 1u).second) return numbered;
    }
}

}  // namespace

ObjectId add_object(Scene& scene, Object object) {
    object.id = scene.next_object_id++;
    object.name = unique_name(scene, std::move(object.name));
    if (object.path.empty()) object.path = "/" + object.name;
    scene.objects.push_back(std::move(object));
    return scene.objects.back().id;
}

MaterialId add_material(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return static_cast<MaterialId>(scene.materials.size() - 1);
}

MeshId add_mesh(Scene& scene, Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    return static_cast<MeshId>(scene.meshes.size() - 1);
}

SetId add_sphere_set(Scene& scene, SphereSet set) {
    scene.sphere_sets.push_back(std::move(set));
    return static_cast<SetId>(scene.sphere_sets.size() - 1);
}

SetId add_cone_set(Scene& scene, ConeSet set) {
    scene.cone_sets.push_back(std::move(set));
    return static_cast<SetId>(scene.cone_sets.size() - 1);
}

TextureId add_texture(Scene& scene, Texture texture) {
    scene.textures.push_back(std::move(texture));
    return static_cast<TextureId>(scene.textures.size() - 1);
}

const Object* find_object(const Scene& scene, ObjectId id) {
    if (scene.objects.empty() || id < scene.objects.front().id) return nullptr;
    // Ids only have gaps where objects were taken away.
    const std::size_t guess = id - scene.objects.front().id;
    if (guess < scene.objects.size() && scene.objects[guess].id == id) return &scene.objects[guess];
    const auto found =
        std::lower_bound(scene.objects.begin(), scene.objects.end(), id,
                         [](const Object& object, ObjectId wanted) { return object.id < wanted; });
    return found != scene.objects.end() && found->id == id ? &*found : nullptr;
}

std::size_t object_index(const Scene& scene, ObjectId id) {
    const Object* object = find_object(scene, id);
    assert(object != nullptr);
    return static_cast<std::size_t>(object - scene.objects.data());
}

MaterialId material_id(const Scene& scene, const Object& object, std::uint32_t primitive) {
    if (object.material != kNoMaterial) return object.material;
    const Part* part = part_of(parts_of(scene, object.shape), primitive);
    return part != nullptr ? part->material : kNoMaterial;
}

const Material& material(const Scene& scene, MaterialId id) {
    static const Material grey;
    return id < scene.materials.size() ? scene.materials[id] : grey;
}

std::span<const Part> parts_of(const Scene& scene, const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshInstance>(&shape)) return scene.meshes[mesh->mesh].parts;
    if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
        return scene.sphere_sets[spheres->set].parts;
    }
    if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
        return scene.cone_sets[cones->set].parts;
    }
    return {};
}

std::uint32_t primitive_count(const Scene& scene, const Object& object) {
    if (const MeshInstance* instance = std::get_if<MeshInstance>(&object.shape)) {
        return static_cast<std::uint32_t>(scene.meshes[instance->mesh].triangles.size());
    }
    if (const auto* spheres = std::get_if<SphereSetInstance>(&object.shape)) {
        return static_cast<std::uint32_t>(scene.sphere_sets[spheres->set].spheres.size());
    }
    if (const auto* cones = std::get_if<ConeSetInstance>(&object.shape)) {
        return static_cast<std::uint32_t>(scene.cone_sets[cones->set].size());
    }
    if (const Cone* cone = std::get_if<Cone>(&object.shape)) return cone->capped ? 3u : 1u;
    return std::holds_alternative<Box>(object.shape) ? 6u : 1u;
}

}  // namespace raypick
