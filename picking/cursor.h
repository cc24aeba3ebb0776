// From a mouse cursor to a pixel.
#pragma once

#include "tracer/geometry/pixel.h"

#include <optional>

namespace raypick {

// A cursor position as GLFW gives it: window units, origin top-left of the content area, x right,
// y down, fractions included.
struct Cursor {
    double x = 0;
    double y = 0;

    friend bool operator==(const Cursor&, const Cursor&) = default;
};

// How window and framebuffer relate at the time of an event. On HiDPI screens the framebuffer has
// more pixels than the window has units, and not always the same ratio in x and y.
struct WindowMetrics {
    double window_width = 0;  // window units
    double window_height = 0;
    int framebuffer_cols = 0;  // pixels
    int framebuffer_rows = 0;
};

// The part of the framebuffer that shows the scene, in framebuffer pixels, top-left origin.
struct ViewRect {
    Pixel top_left;
    ImageSize size;
};

// The pixel of the view under the cursor: floor(cursor * framebuffer / window) on each axis, minus
// the view's corner. Nothing outside the view (never clamped), for a NaN or an empty window.
std::optional<Pixel> pixel_under(Cursor cursor, const WindowMetrics& window, const ViewRect& view);

}  // namespace raypick
