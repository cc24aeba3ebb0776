// The objects of a scene file by their type. A type's keys are checked here and nowhere else: its
// own and the common ones (name, path, id, mask, sides, material, transform).
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/io/json_value.h"
#include "tracer/scene/scene.h"

#include <optional>
#include <string_view>

namespace raypick {

// All types of objects that there are.
extern const std::vector<std::string_view> kObjectTypes;

// A shape that is written with numbers: not "mesh", "spheres", "cones" or "instance". `type` is one
// of kObjectTypes. Throws FileError that names the place of what is wrong.
Shape read_shape(const JsonValue& object, std::string_view type);

void check_mesh_keys(const JsonValue& object);
void check_spheres_keys(const JsonValue& object);
void check_cones_keys(const JsonValue& object);
void check_instance_keys(const JsonValue& object);

// "both", "front" or "back".
Sides read_sides(const JsonValue& value);

}  // namespace raypick
