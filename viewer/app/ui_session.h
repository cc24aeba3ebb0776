// Dear ImGui on our window, from its start to its end.
#pragma once

#include "viewer/app/window.h"

struct ImGuiContext;

namespace raypick {

class UiSession {
public:
    // Draws nothing yet. `ui_scale` as for apply_theme. The window must outlive it.
    UiSession(const Window& window, double ui_scale);
    ~UiSession();
    UiSession(const UiSession&) = delete;
    UiSession& operator=(const UiSession&) = delete;

    void begin_frame();
    // Draws what the panels asked for onto the bound framebuffer.
    void end_frame();

    // A text field has the keyboard.
    [[nodiscard]] bool typing() const;

private:
    ImGuiContext* context_;
};

}  // namespace raypick
