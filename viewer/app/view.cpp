#include "viewer/app/view.h"

#include "tracer/parallel/parallel.h"
#include "viewer/app/app.h"
#include "viewer/app/display.h"
#include "viewer/app/window.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <utility>

namespace raypick {

namespace {

int no_window(const std::string& reason) {
    fmt::print(stderr,
               "raypick: no window can be opened ({}); without one, use `raypick render`, "
               "`raypick pick` or `raypick info`\n",
               reason);
    return 1;
}

// Begins to open the file. Until there is a window, nobody is to be woken.
std::unique_ptr<DocumentOpener> begin_opening(const ViewOptions& options,
                                              const std::shared_ptr<std::atomic<bool>>& window) {
    auto opener = std::make_unique<DocumentOpener>([window] {
        if (*window) Window::wake();
    });
    count_cores();
    if (!options.file.empty()) opener->open(options.file, options.crease_degrees, 0);
    return opener;
}

}  // namespace

int run_view(const ViewOptions& options) {
    auto probe = std::make_unique<DisplayProbe>();
    if (!probe->asks()) return no_window("no display with OpenGL 3.3 answers");
    const auto window_is_there = std::make_shared<std::atomic<bool>>(false);
    std::unique_ptr<DocumentOpener> opener = begin_opening(options, window_is_there);
    if (probe->refuses()) {
        opener.reset();  // and its thread
        probe->ask_again();
        opener = begin_opening(options, window_is_there);
    }
    if (!probe->answers()) return no_window("no display with OpenGL 3.3 answers");
    try {
        InputState input;
        Window window("raypick", options.size, input);
        probe.reset();
        App app(options, window, input, std::move(opener));
        *window_is_there = true;
        app.run();
        return 0;
    } catch (const NoWindow& error) {
        return no_window(error.what());
    }
}

}  // namespace raypick
