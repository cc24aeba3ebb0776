// From a file's name to something that rays can be shot at.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/scene/scene.h"
#include "viewer/cli/options.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace raypick {

struct OpenedScene {
    std::shared_ptr<const Scene> scene;
    std::vector<std::string> warnings;
    double load_seconds = 0.0;
};

// Loads the file and prints its warnings. Throws what load_scene throws.
OpenedScene open_scene(const SceneOptions& options, const std::stop_token& stop = {});

struct BuiltAccel {
    std::shared_ptr<const Accel> accel;
    double build_seconds = 0.0;
};

// Throws Cancelled.
BuiltAccel build_accel(const OpenedScene& opened, bool verbose, int threads = 0,
                       const std::stop_token& stop = {});

// choose_camera; what the person said about it being nonsense is a UsageError.
Camera camera_for(const Scene& scene, ImageSize size, const CameraOverride& wanted);

}  // namespace raypick
