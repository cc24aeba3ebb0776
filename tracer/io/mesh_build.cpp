#include "tracer/io/mesh_build.h"

#include "tracer/scene/normals.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

// Beyond this many extents from 0, float coordinates would cost a model bits that it can use.
constexpr double kFarInExtents = 8.0;

}  // namespace

bool is_coordinate(const glm::dvec3& point) {
    // Written so that NaN fails.
    return std::abs(point.x) <= kLargestCoordinate && std::abs(point.y) <= kLargestCoordinate &&
           std::abs(point.z) <= kLargestCoordinate;
}

std::string coordinate_complaint(const glm::dvec3& point) {
    for (int axis = 0; axis < 3; ++axis) {
        const double value = point[axis];
        if (std::isnan(value)) return fmt::format("{} is not a number", "xyz"[axis]);
        if (std::abs(value) <= kLargestCoordinate) continue;
        return fmt::format("{} is {}: beyond {}", "xyz"[axis], value, kLargestCoordinate);
    }
    return "";
}

glm::vec2 uv_or_zero(double u, double v) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    return {std::abs(u) <= kLargest ? static_cast<float>(u) : 0.0f,
            std::abs(v) <= kLargest ? static_cast<float>(v) : 0.0f};
}

glm::dvec3 storage_origin(const PointBounds& bounds) {
    if (!(bounds.min.x <= bounds.max.x)) return glm::dvec3(0.0);
    const glm::dvec3 size = bounds.max - bounds.min;
    const double extent = std::max({size.x, size.y, size.z});
    const glm::dvec3 centre = 0.5 * bounds.min + 0.5 * bounds.max;
    const glm::dvec3 far = glm::abs(centre);
    if (std::max({far.x, far.y, far.z}) <= kFarInExtents * extent) return glm::dvec3(0.0);
    if (extent == 0.0) return centre;
    // A power of two: subtracting a multiple of it is exact for most coordinates.
    const double smallest = std::max({far.x, far.y, far.z}) * 1e-12;  // keeps the quotient finite
    const double step = std::exp2(std::floor(std::log2(std::max(extent, smallest))));
    return glm::round(centre / step) * step;
}

glm::vec3 unit_or_zero(const glm::dvec3& normal) {
    // Scaled first, so that very long and very short vectors keep their direction.
    const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    const glm::dvec3 scaled = normal / largest;
    const double length = glm::length(scaled);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(scaled / length) : glm::vec3(0.0f);
}

glm::vec3 face_normal(const MeshData& data, const glm::uvec3& t) {
    const glm::dvec3 a = data.positions[t.x];
    const glm::dvec3 b = data.positions[t.y];
    const glm::dvec3 c = data.positions[t.z];
    return unit_or_zero(glm::cross(b - a, c - a));
}

void fill_normals(MeshData& data) {
    for (glm::uvec3& triangle : data.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangle[corner];
            if (data.normals[vertex] != glm::vec3(0.0f)) continue;
            const glm::vec3 normal = face_normal(data, triangle);
            // A degenerate triangle is never hit: any normal will do.
            const glm::vec3 z(0.0f, 0.0f, 1.0f);
            triangle[corner] = static_cast<std::uint32_t>(data.positions.size());
            const glm::vec3 position = data.positions[vertex];
            data.positions.push_back(position);
            data.normals.push_back(normal != glm::vec3(0.0f) ? normal : z);
            if (data.uvs.empty()) continue;
            const glm::vec2 uv = data.uvs[vertex];
            data.uvs.push_back(uv);
        }
    }
    // The vertices that lost their triangles.
    std::replace(data.normals.begin(), data.normals.end(), glm::vec3(0.0f),
                 glm::vec3(0.0f, 0.0f, 1.0f));
}

MeshData with_shading_normals(MeshData data, double crease_degrees) {
    if (data.normals.empty()) return with_crease_normals(std::move(data), crease_degrees);
    fill_normals(data);
    return data;
}

void place_mesh(Scene& scene, const glm::dvec3& origin, Mesh mesh) {
    Object object;
    object.name = mesh.name;
    object.shape = MeshInstance{add_mesh(scene, std::move(mesh))};
    object.world_from_object = translate(origin);
    add_object(scene, std::move(object));
    scene.objects.back().path = '/' + scene.objects.back().name;
}

}  // namespace raypick
