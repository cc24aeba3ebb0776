#include "tracer/error.h"
#include "viewer/app/view.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/default_scene.h"

#include <filesystem>
#include <system_error>

namespace raypick {

int run_view(const ViewCommand& command) {
    ViewOptions options = command.options;
    // The window shows what is wrong with a file; without one, say it here (a mistyped command is
    // a file that isn't there).
    std::error_code ignored;
    const bool missing = !options.file.empty() && !std::filesystem::exists(options.file, ignored);
    if (missing && !display_answers()) throw FileError(options.file.string(), "no such file");
    if (options.file.empty()) options.file = default_scene();
    return run_view(options);
}

int run(const Command& command) {
    struct Runner {
        int operator()(const ViewCommand& c) const { return run_view(c); }
        int operator()(const PickCommand& c) const { return run_pick(c); }
        int operator()(const RenderCommand& c) const { return run_render(c); }
        int operator()(const InfoCommand& c) const { return run_info(c); }
        int operator()(const SaveCommand& c) const { return run_save(c); }
    };
    return std::visit(Runner{}, command);
}

}  // namespace raypick
