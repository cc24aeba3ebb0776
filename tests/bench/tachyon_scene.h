// Writes a scene as a file of Tachyon's, to measure how long it takes.
#pragma once

#include "tracer/geometry/camera.h"
#include "tracer/scene/scene.h"

#include <filesystem>

namespace raypick::bench {

// Spheres, triangles, point lights; diffuse and mirrored light, transparency (which Tachyon doesn't
// bend). Its pictures are mirrored, left for right. Throws std::invalid_argument that names what it
// has no equivalent for.
void write_tachyon_scene(const std::filesystem::path& file, const Scene& scene,
                         const Camera& camera, int depth);

}  // namespace raypick::bench
