#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

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
    std::string label = fmt::format("{}  {} %", state_name(status.state),
                                    static_cast<int>(100.0 * progress.fraction));
    if (progress.passes > 1) {
        label += fmt::format("  pass {} of {}", progress.pass, progress.passes);
    }
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

// One of some names, as a drop-down list.
template <typename Choice, std::size_t N>
bool choose(const char* label, const std::array<const char*, N>& names, Choice& choice) {
    int index = static_cast<int>(choice);
    if (!ImGui::Combo(label, &index, names.data(), static_cast<int>(N))) return false;
    choice = static_cast<Choice>(index);
    return true;
}

bool drag_length(const char* label, double& length, const char* at_zero) {
    constexpr double kLeast = 0.0;
    constexpr double kMost = 1e30;
    const auto speed = static_cast<float>(std::max(1e-3, 0.01 * length));
    const char* format = length > 0.0 ? "%.4g" : at_zero;
    if (!ImGui::DragScalar(label, ImGuiDataType_Double, &length, speed, &kLeast, &kMost, format,
                           ImGuiSliderFlags_AlwaysClamp)) {
        return false;
    }
    // A number that was typed may be none.
    if (!std::isfinite(length)) length = 0.0;
    return true;
}

bool draw_sampling(RenderSettings& settings) {
    constexpr std::array kSamplings{"pixel centre", "pixel corners", "refine", "refine edges"};
    constexpr std::array kFilters{"box", "tent", "Gaussian", "Mitchell"};
    constexpr int kMostSamples = 16;
    bool edited = choose("sampling", kSamplings, settings.sampling);
    const bool adaptive = settings.sampling == Sampling::adaptive;
    if (!adaptive && settings.sampling != Sampling::stratified) return edited;
    const std::string squared = fmt::format("%d x {} a pixel", settings.samples);
    edited |= ImGui::SliderInt("samples", &settings.samples, 1, kMostSamples, squared.c_str(),
                               ImGuiSliderFlags_AlwaysClamp);
    edited |= choose("filter", kFilters, settings.filter);
    if (adaptive) {
        edited |= ImGui::SliderFloat("contrast", &settings.contrast, 0.0f, 1.0f, "%.3f",
                                     ImGuiSliderFlags_AlwaysClamp);
    }
    edited |= drag_length("aperture", settings.aperture, "0 (all sharp)");
    if (settings.aperture > 0.0) {
        edited |= drag_length("focus at", settings.focus_distance, "the pivot");
    }
    return edited;
}

bool draw_glass(RenderSettings& settings) {
    bool tinted = settings.glass_shadows == GlassShadows::tinted;
    bool edited = ImGui::Checkbox("light through glass", &tinted);
    settings.glass_shadows = tinted ? GlassShadows::tinted : GlassShadows::opaque;
    bool all_rays = settings.cutoff == 0.0f;
    if (ImGui::Checkbox("also rays that add nothing", &all_rays)) {
        settings.cutoff = all_rays ? 0.0f : RenderSettings{}.cutoff;
        edited = true;
    }
    return edited;
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
    edited |= draw_glass(settings);
    edited |= draw_sampling(settings);
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
        } else if (panel.status.state == PreviewStatus::State::off) {
            draw_dim_text("Begins once the first tree is there.");
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
