#include "viewer/cli/scene_report.h"

#include <sys/resource.h>

#include <set>

namespace raypick {

SceneCounts count(const Scene& scene) {
    SceneCounts counts;
    for (const Mesh& mesh : scene.meshes)
        counts.unique_triangles += mesh.triangles.size();
    for (const Object& object : scene.objects) {
        const std::uint32_t primitives = primitive_count(scene, object);
        counts.primitives += primitives;
        if (std::holds_alternative<MeshInstance>(object.shape)) counts.triangles += primitives;
        if (std::holds_alternative<Triangle>(object.shape)) {
            ++counts.triangles;
            ++counts.unique_triangles;
        }
    }
    return counts;
}

std::uint64_t mesh_bytes(const Scene& scene) {
    std::set<const void*> seen;
    std::uint64_t bytes = 0;
    const auto add = [&](const auto& array) {
        if (seen.insert(array.data()).second) bytes += array.size_bytes();
    };
    for (const Mesh& mesh : scene.meshes) {
        add(mesh.positions);
        add(mesh.normals);
        add(mesh.uvs);
        add(mesh.triangles);
    }
    return bytes;
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux gives KiB
}

void add_counts(Json& json, const Scene& scene) {
    const SceneCounts counts = count(scene);
    json["objects"] = scene.objects.size();
    json["triangles"] = counts.triangles;
    json["unique_triangles"] = counts.unique_triangles;
    json["primitives"] = counts.primitives;
    json["meshes"] = scene.meshes.size();
}

Json bounds_json(const Scene& scene, const Bounds& bounds) {
    if (bounds.empty()) return nullptr;
    return {{"min", vector_json(scene.origin + glm::dvec3(bounds.min))},
            {"max", vector_json(scene.origin + glm::dvec3(bounds.max))}};
}

Json vector_json(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

std::string dump(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace raypick
