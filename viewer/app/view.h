// The window: opens a scene, lets a person look, click and ray-trace.
#pragma once

#include "tracer/geometry/pixel.h"
#include "tracer/scene/scene.h"

#include <filesystem>

namespace raypick {

struct ViewOptions {
    std::filesystem::path file;  // empty: a window that waits for a file
    ImageSize size{720, 1280};   // of the window, window units
    bool trace = false;          // start with the traced preview
    bool print_picks = false;    // each click's pick as one JSON line on standard output
    double ui_scale = 0.0;       // of fonts and panels; 0: the monitor's content scale
    double crease_degrees = 30.0;
    int depth = 5;
    CameraOverride camera;
};

// True if a window can be opened (a display is named and answers). Never prints.
bool display_answers();

// Runs until the window is closed. Returns the exit code: 0, or 1 with one message on standard
// error if no window can be opened. A file that can't be read is shown in the window.
int run_view(const ViewOptions& options);

}  // namespace raypick
