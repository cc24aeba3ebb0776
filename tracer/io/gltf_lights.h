// The lights of KHR_lights_punctual.
#pragma once

#include "tracer/geometry/transform.h"
#include "tracer/io/gltf_document.h"
#include "tracer/scene/scene.h"

#include <optional>

namespace raypick {

// The light that a node's extension refers to, in the file's units: points and spots in candela,
// which fade by the square of the distance, directional ones in lux. It shines along -z of its
// node. Nothing if the node is scaled to nothing. Throws FileError.
std::optional<Light> read_gltf_light(const GltfDocument& document, const JsonValue& reference,
                                     const JsonValue& node, const Transform& world);

// Scales all lights by the same factor, since files are made for cameras of any exposure: the one
// that is brightest at the centre of the scene gives the irradiance 1 there. A light closer to the
// centre than half the scene's radius counts as if it were that far away, so that a lamp in the
// middle of a room doesn't leave the walls dark.
void expose_gltf_lights(Scene& scene);

}  // namespace raypick
