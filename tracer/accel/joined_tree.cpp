#include "tracer/accel/joined_tree.h"

#include "tracer/accel/triangle_box.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <map>
#include <variant>

namespace raypick {

std::vector<std::uint32_t> count_uses(const Scene& scene) {
    std::vector<std::uint32_t> uses(scene.meshes.size());
    for (const Object& object : scene.objects) {
        if (const auto* instance = std::get_if<MeshInstance>(&object.shape)) ++uses[instance->mesh];
    }
    return uses;
}

namespace {

// With triangles, where one object has them as they are and no other has them.
std::vector<JoinableMesh> meshes_in_place(const Scene& scene) {
    const std::vector<std::uint32_t> uses = count_uses(scene);
    std::vector<JoinableMesh> meshes;
    for (const Object& object : scene.objects) {
        const auto* instance = std::get_if<MeshInstance>(&object.shape);
        if (instance == nullptr || uses[instance->mesh] != 1) continue;
        const Mesh& mesh = scene.meshes[instance->mesh];
        if (!object.world_from_object.is_identity() || mesh.triangles.empty()) continue;
        meshes.push_back({&mesh, {}});
    }
    return meshes;
}

void measure(std::vector<JoinableMesh>& meshes, const BuildOptions& options) {
    parallel_for(meshes.size(), options.threads, options.stop, [&](std::size_t i) {
        const Mesh& mesh = *meshes[i].mesh;
        for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
            meshes[i].bounds.extend(triangle_box(mesh, triangle));
    });
    if (options.stop.stop_requested()) throw Cancelled();
}

}  // namespace

std::vector<JoinableMesh> joinable_meshes(const Scene& scene, const BuildOptions& options) {
    // Boxes that a ray through them all would enter on average. Sponza, cut into 34 by material,
    // has 7.5, and a kitchen of 299 things 3.7: there trees of their own are as good.
    constexpr float kInEachOthersWay = 5.0f;
    std::vector<JoinableMesh> meshes = meshes_in_place(scene);
    measure(meshes, options);
    Bounds all;
    float area = 0.0f;
    std::size_t triangles = 0;
    for (const JoinableMesh& joinable : meshes) {
        all.extend(joinable.bounds);
        area += joinable.bounds.half_area();
        triangles += joinable.mesh->triangles.size();
    }
    const bool pays = area >= kInEachOthersWay * all.half_area();
    const bool possible =
        meshes.size() <= JoinedMeshes::kMostMeshes && triangles <= JoinedMeshes::kMostTriangles;
    if (!pays || !possible) meshes.clear();
    return meshes;
}

std::vector<std::uint32_t> objects_of_members(const Scene& scene,
                                              const std::vector<TreeArrays>& members) {
    std::map<TreeArrays, std::size_t> numbers;
    for (std::size_t i = 0; i < members.size(); ++i)
        numbers.emplace(members[i], i);
    std::vector<std::uint32_t> objects(members.size(), kNobody);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const auto* instance = std::get_if<MeshInstance>(&object.shape);
        if (instance == nullptr || !object.world_from_object.is_identity()) continue;
        const auto found = numbers.find(arrays_of(scene.meshes[instance->mesh]));
        if (found == numbers.end() || objects[found->second] != kNobody) continue;
        objects[found->second] = static_cast<std::uint32_t>(i);
    }
    return objects;
}

}  // namespace raypick
