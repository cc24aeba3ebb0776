#include "viewer/app/view.h"

#include "viewer/app/app.h"
#include "viewer/app/display.h"
#include "viewer/app/window.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

namespace raypick {

namespace {

int no_window(const std::string& reason) {
    fmt::print(stderr,
               "raypick: no window can be opened ({}); without one, use `raypick render`, "
               "`raypick pick` or `raypick info`\n",
               reason);
    return 1;
}

}  // namespace

int run_view(const ViewOptions& options) {
    auto probe = std::make_unique<DisplayProbe>();
    if (!probe->answers()) return no_window("no display with OpenGL 3.3 answers");
    try {
        InputState input;
        Window window("raypick", options.size, input);
        probe.reset();
        App app(options, window, input);
        app.run();
        return 0;
    } catch (const NoWindow& error) {
        return no_window(error.what());
    }
}

}  // namespace raypick
