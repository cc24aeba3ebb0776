// Where things stand in the window.
#pragma once

#include "viewer/app/input_state.h"

namespace raypick {

// The scene's view is what the side panel on the right and the status bar at the bottom leave.
struct Layout {
    WindowMetrics window;
    ViewRect view;
    UiRegion side_panel;  // empty if the panels are hidden
    UiRegion status_bar;
};

// `ui_scale` scales panels in window units. A narrow window gives at most half its width to the
// panel.
Layout lay_out(const WindowMetrics& window, double ui_scale, bool panels);

}  // namespace raypick
