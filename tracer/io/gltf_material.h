// A glTF file's materials.
#pragma once

#include "tracer/io/gltf_document.h"
#include "tracer/io/imported_material.h"

#include <string>
#include <vector>

namespace raypick {

// `json` is an element of /materials. Maps that can't be shown become warnings. Throws FileError
// with the JSON path.
GltfMaterial read_gltf_material(GltfDocument& document, const JsonValue& json,
                                std::vector<std::string>& warnings);

}  // namespace raypick
