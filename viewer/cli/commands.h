// The commands. Each returns its exit code, or throws what exit_code.h maps to one.
#pragma once

#include "viewer/cli/options.h"

namespace raypick {

// Runs whichever it is.
int run(const Command& command);

// Opens the window. Without a FILE: the default scene if it is installed.
int run_view(const ViewCommand& command);
// Prints what lies under pixels or along rays, one JSON object a line.
int run_pick(const PickCommand& command);
// Writes an image.
int run_render(const RenderCommand& command);
// Prints what a file holds.
int run_info(const InfoCommand& command);
// Writes the scene as one of our scene files.
int run_save(const SaveCommand& command);

}  // namespace raypick
