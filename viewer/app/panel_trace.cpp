#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

namespace raypick {

namespace {

const char* state_name(PreviewStatus::State state) {
    switch (state) {
        case PreviewStatus::State::off:
            return "off";
        case PreviewStatus::State::tracing:
            return "tracing";
        case PreviewStatus::State::finished:
            return "finished";
        case PreviewStatus::State::cancelled:
            return "stopped";
        case PreviewStatus::State::failed:
            return "failed";
    }
    return "";
}

void draw_progress(const PreviewStatus& status) {
    const RenderProgress& progress = status.progress;
    // A fraction that is not quite 1 must not read as 100 %.
    const std::string label = fmt::format("{}  {} %", state_name(status.state),
                                          static_cast<int>(100.0 * progress.fraction));
    ImGui::ProgressBar(static_cast<float>(progress.fraction), ImVec2(-1.0f, 0.0f), label.c_str());
    if (!begin_values("trace")) return;
    const auto rays = static_cast<double>(progress.rays.total());
    draw_value("time", short_time(progress.seconds));
    draw_value("rays", short_count(rays));
    draw_value("rays/s", progress.seconds > 0.0 ? short_count(rays / progress.seconds) : "");
    end_values();
}

}  // namespace

bool draw_trace_settings(RenderSettings& settings) {
    constexpr int kLargestDepth = 32;
    bool edited = ImGui::SliderInt("depth", &settings.depth, 1, kLargestDepth, "%d",
                                   ImGuiSliderFlags_AlwaysClamp);
    edited |= ImGui::Checkbox("shadows", &settings.shadows);
    edited |= ImGui::Checkbox("reflections", &settings.reflections);
    edited |= ImGui::Checkbox("refractions", &settings.refractions);
    return edited;
}

std::optional<TraceRequest> draw_trace_panel(const TracePanel& panel) {
    std::optional<TraceRequest> request;
    ImGui::BeginDisabled(!panel.can_trace);
    const char* label = panel.on ? "Back to OpenGL  (R)" : "Ray trace this view  (R)";
    if (draw_wide_button(label, panel.on)) request = TraceRequest::toggle;
    ImGui::EndDisabled();
    if (panel.on) {
        if (panel.status.state == PreviewStatus::State::failed) {
            draw_error_text(panel.status.error);
        } else {
            draw_progress(panel.status);
        }
        const bool tracing = panel.status.state == PreviewStatus::State::tracing;
        ImGui::BeginDisabled(!tracing);
        if (draw_wide_button("Stop  (Esc)")) request = TraceRequest::cancel;
        ImGui::EndDisabled();
    }
    ImGui::BeginDisabled(!panel.can_trace || panel.saving);
    if (draw_wide_button(panel.saving ? "Saving..." : "Save picture...  (Ctrl+S)")) {
        request = TraceRequest::save;
    }
    ImGui::EndDisabled();
    return request;
}

}  // namespace raypick
