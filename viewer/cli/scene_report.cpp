#include "viewer/cli/scene_report.h"

#include <sys/resource.h>
#include <glm/common.hpp>

#include <array>
#include <charconv>
#include <set>

namespace raypick {
namespace {

void extend(std::optional<ObjectExtent>& extent, const ObjectExtent& by) {
    if (!extent) extent = by;
    extent->min = glm::min(extent->min, by.min);
    extent->max = glm::max(extent->max, by.max);
}

}  // namespace

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

std::optional<ObjectExtent> file_extent(const Scene& scene, const Object& object) {
    const std::optional<ObjectExtent> local = object_extent(scene, object.shape);
    if (!local) return std::nullopt;
    std::optional<ObjectExtent> extent;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1u) == 0 ? local->min.x : local->max.x,
                           (corner & 2u) == 0 ? local->min.y : local->max.y,
                           (corner & 4u) == 0 ? local->min.z : local->max.z);
        const glm::dvec3 in_file = scene.origin + object.world_from_object.point(p);
        extend(extent, {in_file, in_file});
    }
    return extent;
}

std::optional<ObjectExtent> file_extent(const Scene& scene) {
    std::optional<ObjectExtent> extent;
    for (const Object& object : scene.objects) {
        if (object.mask == 0) continue;
        if (const auto one = file_extent(scene, object)) extend(extent, *one);
    }
    return extent;
}

Json extent_json(const std::optional<ObjectExtent>& extent) {
    if (!extent) return nullptr;
    return {{"min", vector_json(extent->min)}, {"max", vector_json(extent->max)}};
}

Json vector_json(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json vector_json(const glm::vec3& v) {
    return Json::array({shortest_decimal(v.x), shortest_decimal(v.y), shortest_decimal(v.z)});
}

double shortest_decimal(float value) {
    std::array<char, 32> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
    double decimal = value;
    std::from_chars(text.data(), written.ptr, decimal);
    return decimal;
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace raypick
