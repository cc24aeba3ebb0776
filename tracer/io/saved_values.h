// The parts of a scene as a scene file has them; what has its default value is left out. The
// readers are in scene_values.h, scene_looks.h, scene_arrays.h and scene_shapes.h.
#pragma once

#include "tracer/io/json_writer.h"
#include "tracer/scene/scene.h"

namespace raypick {

void write_value(JsonWriter& json, const NamedCamera& named);
void write_value(JsonWriter& json, const Light& light);
void write_value(JsonWriter& json, const Environment& environment);
void write_value(JsonWriter& json, const Texture& texture);
void write_value(JsonWriter& json, const Material& material);
void write_value(JsonWriter& json, const Mesh& mesh);
void write_value(JsonWriter& json, const SphereSet& set);
void write_value(JsonWriter& json, const ConeSet& set);
// `next_id` is what it would have if its file didn't say.
void write_value(JsonWriter& json, const Object& object, ObjectId next_id);

}  // namespace raypick
