// A mesh's triangles as builders of trees read them.
#pragma once

#include "tracer/bvh/float4.h"
#include "tracer/geometry/bounds.h"
#include "tracer/scene/scene.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace raypick {

// With a fourth lane that means nothing.
inline Float4 vertex_position(const Mesh& mesh, std::uint32_t vertex) {
    const glm::vec3* const at = &mesh.positions[vertex];
    if (vertex + std::size_t{1} == mesh.positions.size()) return Float4{at->x, at->y, at->z, 0.0f};
    Float4 position;  // all four at once, as there is something behind the three
    std::memcpy(&position, at, sizeof position);
    return position;
}

// A triangle with a NaN is never hit: its box is empty.
inline Box4 triangle_box4(const Mesh& mesh, std::size_t index) {
    const glm::uvec3 t = mesh.triangles[index];
    const Float4 a = vertex_position(mesh, t.x);
    const Float4 b = vertex_position(mesh, t.y);
    const Float4 c = vertex_position(mesh, t.z);
    const Float4 sum = a + b + c;
    if (!std::isfinite(sum[0] + sum[1] + sum[2])) return {};
    return {min4(min4(a, b), c), max4(max4(a, b), c)};
}
inline Bounds triangle_box(const Mesh& mesh, std::size_t index) {
    return triangle_box4(mesh, index).bounds();
}

}  // namespace raypick
