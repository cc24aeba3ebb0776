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

// Loads the file. Throws what load_scene throws.
OpenedScene load_timed(const SceneOptions& options, const std::stop_token& stop = {});
// What loading had to say: its warnings and, if asked for, its time.
void print_report(const OpenedScene& opened, const SceneOptions& options);
// Both.
OpenedScene open_scene(const SceneOptions& options);

struct BuiltAccel {
    std::shared_ptr<const Accel> accel;
    double build_seconds = 0.0;
};

// Throws Cancelled.
BuiltAccel build_timed(const OpenedScene& opened, const BuildOptions& options = {});
// Its size and time.
void print_report(const BuiltAccel& built);

// choose_camera; what the person said about it being nonsense is a UsageError.
Camera camera_for(const Scene& scene, ImageSize size, const CameraOverride& wanted);

}  // namespace raypick
