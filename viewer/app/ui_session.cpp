#include "viewer/app/ui_session.h"

#include "viewer/app/theme.h"

#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

namespace raypick {

UiSession::UiSession(const Window& window, double ui_scale) : context_(ImGui::CreateContext()) {
    IMGUI_CHECKVERSION();
    ImGui::GetIO().IniFilename = nullptr;
    const WindowMetrics metrics = window.metrics();
    const double density =
        metrics.window_height > 0.0 ? metrics.framebuffer_rows / metrics.window_height : 1.0;
    apply_theme(ui_scale, density > 0.0 ? density : 1.0);
    // Its callbacks call ours, which were installed before.
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

UiSession::~UiSession() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(context_);
}

void UiSession::begin_frame() {
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void UiSession::end_frame() {
    ImGui::SetCurrentContext(context_);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool UiSession::typing() const {
    ImGui::SetCurrentContext(context_);
    return ImGui::GetIO().WantTextInput;
}

}  // namespace raypick
