// What stands around and over the view: side panel, status bar, hint, load card.
#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

namespace raypick {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

ImVec2 vec2(double x, double y) {
    return {static_cast<float>(x), static_cast<float>(y)};
}

void place_window(const UiRegion& place) {
    ImGui::SetNextWindowPos(vec2(place.x, place.y));
    ImGui::SetNextWindowSize(vec2(place.width, place.height));
}

void draw_centred(const char* text) {
    const float width = ImGui::CalcTextSize(text).x;
    ImGui::SetCursorPosX(0.5f * (ImGui::GetWindowWidth() - width));
    ImGui::TextUnformatted(text);
}

std::string describe(const OpenProgress& progress) {
    return fmt::format("reading  {:.1f} s", progress.seconds);
}

}  // namespace

void begin_side_panel(const UiRegion& place) {
    place_window(place);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::Begin("##side", nullptr, kFixed);
    ImGui::PushItemWidth(0.55f * ImGui::GetContentRegionAvail().x);
}

void end_side_panel() {
    ImGui::PopItemWidth();
    ImGui::End();
    ImGui::PopStyleVar();
}

void draw_status_bar(const StatusBar& bar, const UiRegion& place) {
    place_window(place);
    const float gap = 0.5f * (static_cast<float>(place.height) - ImGui::GetTextLineHeight());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        ImVec2(ImGui::GetStyle().WindowPadding.x, gap));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
    ImGui::Begin("##status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
    const float right = ImGui::CalcTextSize(bar.right.c_str()).x;
    const float padding = ImGui::GetStyle().WindowPadding.x;
    const float right_start = static_cast<float>(place.width) - right - padding;
    // Long names end before the right part begins.
    ImGui::PushClipRect(vec2(place.x, place.y),
                        {right_start - padding, static_cast<float>(place.y + place.height)}, true);
    ImGui::TextUnformatted(bar.left.c_str());
    ImGui::PopClipRect();
    ImGui::SameLine(right_start);
    ImGui::TextDisabled("%s", bar.right.c_str());
    ImGui::End();
    ImGui::PopStyleVar(3);
}

void draw_empty_hint(const UiRegion& view) {
    place_window(view);
    ImGui::Begin("##hint", nullptr,
                 kFixed | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoInputs);
    ImGui::SetCursorPosY(0.5f * ImGui::GetWindowHeight() - ImGui::GetTextLineHeightWithSpacing());
    draw_centred("Drop a file here, or press Ctrl+O");
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    draw_centred("OBJ, glTF, GLB, PLY, STL, or a raypick scene (JSON)");
    ImGui::PopStyleColor();
    ImGui::End();
}

LoadCard draw_load_card(const OpenProgress& progress, const UiRegion& view, bool in_middle) {
    const float width = 22.0f * ImGui::GetFontSize();
    if (in_middle) {
        ImGui::SetNextWindowPos(vec2(view.x + 0.5 * view.width, view.y + 0.5 * view.height),
                                ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    } else {
        const float gap = ImGui::GetStyle().WindowPadding.x;
        ImGui::SetNextWindowPos(vec2(view.x + gap, view.y + gap));
    }
    ImGui::SetNextWindowSize(ImVec2(width, 0.0f));
    ImGui::Begin("##load", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize);
    draw_text(fmt::format("Opening {}", progress.file.filename().string()));
    ImGui::ProgressBar(progress.fraction, ImVec2(-1.0f, 0.0f), describe(progress).c_str());
    LoadCard card;
    card.cancelled = ImGui::Button("Cancel");
    const ImVec2 corner = ImGui::GetWindowPos();
    const ImVec2 size = ImGui::GetWindowSize();
    card.place = {corner.x, corner.y, size.x, size.y};
    ImGui::End();
    return card;
}

}  // namespace raypick
