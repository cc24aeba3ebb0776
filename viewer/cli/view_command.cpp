#include "viewer/app/view.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/default_scene.h"

namespace raypick {

int run_view(const ViewCommand& command) {
    ViewOptions options = command.options;
    if (options.file.empty()) options.file = default_scene();
    return run_view(options);
}

int run(const Command& command) {
    struct Runner {
        int operator()(const ViewCommand& c) const { return run_view(c); }
        int operator()(const PickCommand& c) const { return run_pick(c); }
        int operator()(const RenderCommand& c) const { return run_render(c); }
        int operator()(const InfoCommand& c) const { return run_info(c); }
    };
    return std::visit(Runner{}, command);
}

}  // namespace raypick
