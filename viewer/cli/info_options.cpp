#include "viewer/cli/command_options.h"
#include "viewer/cli/shared_options.h"

namespace raypick {

void add_info_options(CLI::App& app, InfoCommand& command) {
    add_scene(app, command.scene);
    app.add_flag("--json", command.json, "As one JSON object");
    app.add_flag("--objects", command.objects, "List every object");
}

}  // namespace raypick
