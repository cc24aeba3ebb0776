// A view as words of the command line, so that it can be repeated there.
#pragma once

#include "tracer/geometry/camera.h"

#include <glm/vec3.hpp>

#include <string>

namespace raypick {

// "--eye=X,Y,Z --look-at=X,Y,Z --up=X,Y,Z --fovy=DEG --resolution=W,H", or --orthographic=HEIGHT in
// place of --fovy. Numbers are in file coordinates and as long as they need to be to mean the same
// doubles. `origin` is the scene's.
std::string view_words(const Camera& camera, const glm::dvec3& origin, ImageSize size);

}  // namespace raypick
