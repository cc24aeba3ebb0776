// The parts of a scene file that stand for themselves: cameras, lights, transforms. Each reader
// throws FileError that names the place of what is wrong.
#pragma once

#include "tracer/geometry/transform.h"
#include "tracer/io/json_value.h"
#include "tracer/scene/light.h"
#include "tracer/scene/scene.h"

#include <string>

namespace raypick {

NamedCamera read_camera(const JsonValue& value, std::string default_name);
Light read_light(const JsonValue& value);

// From an object's "translate", "rotate" and "scale" (applied in the opposite order) or "matrix".
Transform read_transform(const JsonValue& object);

}  // namespace raypick
