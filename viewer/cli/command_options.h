// The table of options, command by command. Each function adds a command's options, which write
// into `command` as they are read; finish_... looks at them together once all are read and throws
// CLI::ValidationError if they don't fit. `command` must outlive `app`.
#pragma once

#include "viewer/cli/options.h"

#include <CLI/CLI.hpp>

namespace raypick {

void add_view_options(CLI::App& app, ViewCommand& command);

void add_pick_options(CLI::App& app, PickCommand& command);
void finish_pick(const PickCommand& command);

void add_render_options(CLI::App& app, RenderCommand& command);
void finish_render(const CLI::App& app, RenderCommand& command);

void add_info_options(CLI::App& app, InfoCommand& command);

void add_save_options(CLI::App& app, SaveCommand& command);
void finish_save(const SaveCommand& command);

}  // namespace raypick
