#include "viewer/app/layout.h"

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

constexpr double kPanelWidth = 310.0;
constexpr double kBarHeight = 26.0;

int pixels(double window_units, double window_extent, int framebuffer_extent) {
    if (!(window_extent > 0.0)) return 0;
    return static_cast<int>(std::floor(window_units * framebuffer_extent / window_extent));
}

}  // namespace

Layout lay_out(const WindowMetrics& window, double ui_scale, bool panels) {
    Layout layout;
    layout.window = window;
    double width = window.window_width;
    double height = window.window_height;
    if (panels) {
        const double panel = std::floor(std::min(kPanelWidth * ui_scale, 0.5 * width));
        const double bar = std::floor(std::min(kBarHeight * ui_scale, 0.5 * height));
        width -= panel;
        height -= bar;
        layout.side_panel = {width, 0.0, panel, height};
        layout.status_bar = {0.0, height, window.window_width, bar};
    }
    layout.view.size = {pixels(height, window.window_height, window.framebuffer_rows),
                        pixels(width, window.window_width, window.framebuffer_cols)};
    return layout;
}

}  // namespace raypick
