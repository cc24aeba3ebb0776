// How the panels look.
#pragma once

namespace raypick {

// Sets the current ImGui context's colours, spacing and font. `ui_scale` scales in window units;
// `density` is framebuffer pixels a window unit, so that letters are drawn at the screen's own
// resolution. Call before the first frame.
void apply_theme(double ui_scale, double density);

}  // namespace raypick
