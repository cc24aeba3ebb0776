// The parts of a scene file that stand for themselves: cameras, lights, materials, transforms,
// shapes. Each reader throws FileError that names the JSON path of what is wrong.
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/geometry/transform.h"
#include "tracer/io/json_value.h"
#include "tracer/scene/light.h"
#include "tracer/scene/material.h"
#include "tracer/scene/scene.h"

#include <string>

namespace raypick {

// [r, g, b] or one number for all three, linear.
glm::vec3 read_colour(const JsonValue& value);

NamedCamera read_camera(const JsonValue& value, std::string default_name);
Light read_light(const JsonValue& value);
Material read_material(const JsonValue& value, std::string name);

// From an object's "translate", "rotate" and "scale" (applied in the opposite order) or "matrix".
Transform read_transform(const JsonValue& object);

// Objects of each type: their own keys are read, the common ones (name, material, transform) are
// allowed. A type's keys are checked here and nowhere else.
Sphere read_sphere(const JsonValue& object);
Plane read_plane(const JsonValue& object);
Triangle read_triangle(const JsonValue& object);
Box read_box(const JsonValue& object);
void check_mesh_keys(const JsonValue& object);
void check_instance_keys(const JsonValue& object);

// A mesh that is written in the scene file. Its positions are relative to `origin`, because floats
// would not hold them where they lie far from 0.
struct InlineMesh {
    MeshData data;  // with normals only if the file gives them
    glm::dvec3 origin{0.0};
};
InlineMesh read_inline_mesh(const JsonValue& object);

}  // namespace raypick
