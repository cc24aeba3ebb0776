#include "tracer/geometry/shapes.h"

#include "tracer/error.h"
#include "tracer/geometry/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace raypick {

namespace {

void check_length(const Mesh& mesh, const char* array, std::size_t length) {
    if (length == 0 || length == mesh.positions.size()) return;
    throw Error(fmt::format("mesh \"{}\": {} {} for {} positions: give one a position or none",
                            mesh.name, length, array, mesh.positions.size()));
}

void check_indices(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        const std::uint32_t largest = std::max({t.x, t.y, t.z});
        if (largest >= count) {
            throw Error(fmt::format("mesh \"{}\": triangle {} uses position {}, but there are {}",
                                    mesh.name, i, largest, count));
        }
    }
}

}  // namespace

Mesh make_mesh(std::string name, MeshData data, std::vector<Part> parts) {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.parts = std::move(parts);
    mesh.storage = std::make_shared<const MeshData>(std::move(data));
    mesh.positions = mesh.storage->positions;
    mesh.normals = mesh.storage->normals;
    mesh.uvs = mesh.storage->uvs;
    mesh.triangles = mesh.storage->triangles;
    return mesh;
}

Mesh borrow_mesh(std::string name, std::span<const glm::vec3> positions,
                 std::span<const glm::uvec3> triangles, std::span<const glm::vec3> normals) {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.positions = positions;
    mesh.normals = normals;
    mesh.triangles = triangles;
    return mesh;
}

void check_mesh(const Mesh& mesh) {
    // Corners and tree nodes are numbered in 32 bits.
    constexpr std::size_t kMostTriangles = std::size_t{1} << 30;
    if (mesh.triangles.size() > kMostTriangles) {
        throw Error(
            fmt::format("mesh \"{}\": {} triangles are too many, split it into meshes of {}",
                        mesh.name, mesh.triangles.size(), kMostTriangles));
    }
    check_length(mesh, "normals", mesh.normals.size());
    check_length(mesh, "uvs", mesh.uvs.size());
    check_indices(mesh);
    check_parts("mesh", mesh.name, "triangle", mesh.parts, mesh.triangles.size());
}

}  // namespace raypick
