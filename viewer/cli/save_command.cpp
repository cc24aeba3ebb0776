#include "tracer/io/save_scene.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/interrupt.h"
#include "viewer/cli/open_scene.h"
#include "viewer/cli/progress_bar.h"

#include <fmt/format.h>

namespace raypick {

int run_save(const SaveCommand& command) {
    const Interrupt interrupt;
    try {
        ProgressBar bar;
        bar.show("loading");
        const OpenedScene opened = load_timed(command.scene, interrupt.token());
        bar.clear();
        print_report(opened, command.scene);
        bar.show("saving");
        SaveOptions options;
        options.stop = interrupt.token();
        save_scene(*opened.scene, command.output, options);
    } catch (const Cancelled&) {
        interrupt.check();
        throw;
    }
    if (command.scene.verbose) print_message(fmt::format("wrote {}", command.output.string()));
    return kExitOk;
}

}  // namespace raypick
