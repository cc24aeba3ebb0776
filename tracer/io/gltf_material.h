// A glTF file's materials.
#pragma once

#include "tracer/io/gltf_document.h"
#include "tracer/io/imported_material.h"

namespace raypick {

// `json` is an element of /materials. Throws FileError with the JSON path.
GltfMaterial read_gltf_material(const JsonValue& json);

}  // namespace raypick
