// Writes a scene as a POV-Ray 3.7 file and reads the picture that it makes of it, for tests that
// hold our pictures against POV-Ray's.
#pragma once

#include "tracer/geometry/camera.h"
#include "tracer/render/image.h"
#include "tracer/scene/scene.h"
#include "tracer/shade/settings.h"

#include <filesystem>

namespace raypick {

// Writes scene.pov and its images into a folder: the same view of the same scene in linear colour,
// as long a chain of rays. Area lights get a regular grid of `area_samples` x `area_samples`
// points. Throws std::invalid_argument that names what POV-Ray has no equivalent for, or what this
// writer doesn't know.
void write_pov_scene(const std::filesystem::path& folder, const Scene& scene, const Camera& camera,
                     ImageSize size, const RenderSettings& settings, int area_samples);

// Of the file that POV-Ray writes with +FP16 File_Gamma=1.0: 16-bit PPM, linear. Empty if it is
// none.
Image read_pov_picture(const std::filesystem::path& file);

}  // namespace raypick
