// Options that several commands have.
#pragma once

#include "viewer/cli/options.h"

#include <CLI/CLI.hpp>

#include <string>

namespace raypick {

// FILE and how to read it.
void add_scene(CLI::App& app, SceneOptions& scene);
void add_crease(CLI::App& app, double& crease_degrees);
void add_camera(CLI::App& app, CameraOverride& camera);
void add_resolution(CLI::App& app, const std::string& description, ImageSize& size);
void add_depth(CLI::App& app, int& depth);

}  // namespace raypick
