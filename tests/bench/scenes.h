// The scenes that are measured, each with a view and a light.
#pragma once

#include "tests/bench/report.h"
#include "tracer/geometry/camera.h"
#include "tracer/scene/scene.h"

#include <glm/vec3.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace raypick::bench {

struct View {
    std::string name;
    std::shared_ptr<const Scene> scene;
    Camera camera;
    glm::dvec3 light{0.0};  // where shadow rays go to; scene.lights has it
};

// The file of bunny, sponza, kitchen, scopia, balls or rings. scopia is unpacked first, into the
// run's folder. Nothing, with a word to the report, if it is not there.
std::optional<std::filesystem::path> model_file(const std::string& name, Report& report);

// One of those as it is measured. So that Embree can have the same: both sides of all surfaces,
// cylinders closed, nothing cut out by textures. Also
//   bunny64             the bunny with 64 times as many triangles (each cut into four, thrice)
//   bunny_mirror        the bunny on a mirror
//   sponza_mirror       the courtyard with a mirror for a floor
//   lattice             a grid of mirrors, glass and matt balls
std::optional<View> open_view(const std::string& name, Report& report);

}  // namespace raypick::bench
