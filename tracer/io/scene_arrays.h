// Meshes and sets that are written in a scene file, as numbers or as embedded arrays.
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/io/json_value.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <functional>
#include <vector>

namespace raypick {

// What a part's "material" means.
using MaterialReader = std::function<MaterialId(const JsonValue&)>;

// Positions are relative to `origin`, because floats would not hold numbers that lie far from 0.
// Embedded arrays are taken as they are: their origin is 0.
struct InlineMesh {
    MeshData data;  // with normals only if the file gives them
    std::vector<Part> parts;
    glm::dvec3 origin{0.0};
};

struct InlineSet {
    std::vector<glm::vec4> elements;  // of spheres, or ends of cones
    std::vector<Part> parts;
    glm::dvec3 origin{0.0};
};

// From "positions", "triangles", "normals", "uvs" and "parts". All throw FileError that names the
// place of what is wrong.
InlineMesh read_inline_mesh(const JsonValue& object, const MaterialReader& read_material);
// From "spheres" and "parts", and from "cones" and "parts".
InlineSet read_inline_spheres(const JsonValue& object, const MaterialReader& read_material);
InlineSet read_inline_cones(const JsonValue& object, const MaterialReader& read_material);

}  // namespace raypick
