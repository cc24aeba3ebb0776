// What all model readers do between a file's numbers and a Mesh.
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <limits>
#include <string>

namespace raypick {

// False for NaN, infinities and what is too large.
bool is_coordinate(const glm::dvec3& point);
// What to say of a point that is none.
std::string coordinate_complaint(const glm::dvec3& point);

// Texture coordinates as float; 0 for what is no finite float.
glm::vec2 uv_or_zero(double u, double v);

// Bounds of a file's vertices.
struct PointBounds {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    void extend(const glm::dvec3& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
};

// The point that a file's vertices are stored relative to, as float: 0 where float resolves them
// well as they are, else near their middle, rounded so that few digits change.
glm::dvec3 storage_origin(const PointBounds& bounds);

// Unit length; 0 if `normal` has no direction (zero, NaN, infinite).
glm::vec3 unit_or_zero(const glm::dvec3& normal);

// The side from which the triangle turns counter-clockwise: unit length, 0 if it is degenerate.
glm::vec3 face_normal(const MeshData& data, const glm::uvec3& t);

// Gives a mesh its shading normals: those of the file (unit length, or 0 where the file has none
// that is good: such corners get their face's normal), else by the crease angle.
MeshData with_shading_normals(MeshData data, double crease_degrees);

// Adds a mesh and an object of its name that shows it, moved by `origin`. The object's path is its
// (unique) name.
void place_mesh(Scene& scene, const glm::dvec3& origin, Mesh mesh);

// Gives every corner whose normal is 0 the normal of its face, at a vertex of its own.
void fill_normals(MeshData& data);

}  // namespace raypick
