#include "viewer/cli/command_options.h"
#include "viewer/cli/option_values.h"
#include "viewer/cli/shared_options.h"

namespace raypick {

void add_view_options(CLI::App& app, ViewCommand& command) {
    ViewOptions& options = command.options;
    app.add_option("FILE", options.file, "What to open; without it the default scene")
        ->type_name("");
    add_resolution(app, "Size of the window [1280,720]", options.size);
    app.add_flag("--trace", options.trace, "Begin with the ray-traced preview");
    app.add_flag("--print-picks", options.print_picks,
                 "Print each click's pick as a line of JSON on standard output");
    add_value(app, "--ui-scale", "N", "Size of fonts and panels; 0: the monitor's own [0]",
              [&options](const std::string& text) {
                  options.ui_scale =
                      number_in("--ui-scale", text, 0.0, 8.0, "a number from 0 to 8");
              });
    add_depth(app, options.depth);
    add_camera(app, options.camera);
    add_crease(app, options.crease_degrees);
}

}  // namespace raypick
