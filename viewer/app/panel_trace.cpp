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

void draw_rays(const RenderProgress& progress) {
    if (!begin_values("trace")) return;
    const auto rays = static_cast<double>(progress.rays.total());
    draw_value("time", short_time(progress.seconds));
    draw_value("rays", short_count(rays));
    draw_value("rays/s", progress.seconds > 0.0 ? short_count(rays / progress.seconds) : "");
    end_values();
}

// True if the person wants it to stop.
bool draw_progress(const PreviewStatus& status) {
    const RenderProgress& progress = status.progress;
    // A fraction that is not quite 1 must not read as 100 %.
    const std::string label = fmt::format("{}  {} %", state_name(status.state),
                                          static_cast<int>(100.0 * progress.fraction));
    bool stop = false;
    const bool tracing = status.state == PreviewStatus::State::tracing;
    const float button = tracing ? 4.0f * ImGui::GetFontSize() : 0.0f;
    const float gap = tracing ? ImGui::GetStyle().ItemSpacing.x : 0.0f;
    const ImVec2 bar(ImGui::GetContentRegionAvail().x - button - gap, 0.0f);
    ImGui::ProgressBar(static_cast<float>(progress.fraction), bar, label.c_str());
    if (tracing) {
        ImGui::SameLine();
        stop = ImGui::Button("Stop", ImVec2(button, 0.0f));
    }
    draw_rays(progress);
    return stop;
}

}  // namespace

bool draw_trace_settings(RenderSettings& settings) {
    constexpr int kLargestDepth = 32;
    bool edited = ImGui::SliderInt("depth", &settings.depth, 1, kLargestDepth, "%d",
                                   ImGuiSliderFlags_AlwaysClamp);
    edited |= ImGui::Checkbox("shadows", &settings.shadows);
    ImGui::SameLine(0.5f * ImGui::GetWindowWidth());
    edited |= ImGui::Checkbox("reflections", &settings.reflections);
    edited |= ImGui::Checkbox("refractions", &settings.refractions);
    return edited;
}

std::optional<TraceRequest> draw_trace_panel(const TracePanel& panel) {
    draw_heading("Ray tracing");
    std::optional<TraceRequest> request;
    ImGui::BeginDisabled(!panel.can_trace);
    const char* label = panel.on ? "Back to OpenGL  (R)" : "Ray trace this view  (R)";
    if (draw_wide_button(label, panel.on)) request = TraceRequest::toggle;
    ImGui::EndDisabled();
    if (panel.on) {
        if (panel.status.state == PreviewStatus::State::failed) {
            draw_error_text(panel.status.error);
        } else if (draw_progress(panel.status)) {
            request = TraceRequest::cancel;
        }
    }
    ImGui::BeginDisabled(!panel.can_trace || panel.saving);
    if (draw_wide_button(panel.saving ? "Saving..." : "Save picture...  (Ctrl+S)")) {
        request = TraceRequest::save;
    }
    ImGui::EndDisabled();
    return request;
}

}  // namespace raypick
