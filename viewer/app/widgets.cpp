#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cstddef>

namespace raypick {

namespace {

const ImVec4 kErrorColour{1.0f, 0.48f, 0.42f, 1.0f};
const ImVec4 kHeading{1.0f, 0.72f, 0.40f, 1.0f};
const ImVec4 kLit{0.62f, 0.34f, 0.06f, 1.0f};
const ImVec4 kLitHovered{0.70f, 0.39f, 0.08f, 1.0f};

void draw_wrapped(std::string_view text) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    ImGui::PopTextWrapPos();
}

void draw_coloured(std::string_view text, const ImVec4& colour) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    draw_wrapped(text);
    ImGui::PopStyleColor();
}

}  // namespace

void draw_heading(const char* text) {
    const float gap = 0.4f * ImGui::GetFontSize();
    ImGui::Dummy(ImVec2(0.0f, gap));
    ImGui::PushStyleColor(ImGuiCol_Text, kHeading);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::Separator();
}

void draw_text(std::string_view text) {
    draw_wrapped(text);
}

void draw_dim_text(std::string_view text) {
    draw_coloured(text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
}

void draw_error_text(std::string_view text) {
    draw_coloured(text, kErrorColour);
}

bool begin_values(const char* id) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit)) return false;
    // Wide enough for the longest name, so that all tables of a panel line up.
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 5.5f * ImGui::GetFontSize());
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

void draw_value(const char* name, const std::string& value) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", name);
    ImGui::TableNextColumn();
    draw_wrapped(value);
}

void end_values() {
    ImGui::EndTable();
}

bool draw_wide_button(const char* label, bool lit) {
    if (lit) {
        ImGui::PushStyleColor(ImGuiCol_Button, kLit);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, kLitHovered);
        ImGui::PushStyleColor(ImGuiCol_ButtonActive, kLitHovered);
    }
    const bool pressed = ImGui::Button(label, ImVec2(-1.0f, 0.0f));
    if (lit) ImGui::PopStyleColor(3);
    return pressed;
}

std::string short_count(double count) {
    constexpr const char* kUnits[] = {"", " k", " M", " G", " T"};
    std::size_t unit = 0;
    // 999.5 would be shown as 1e+03.
    while (count >= 999.5 && unit + 1 < std::size(kUnits)) {
        count /= 1000.0;
        ++unit;
    }
    return fmt::format("{:.3g}{}", count, kUnits[unit]);
}

std::string short_time(double seconds) {
    if (seconds < 0.9995) return fmt::format("{:.3g} ms", 1000.0 * seconds);
    if (seconds < 99.95) return fmt::format("{:.3g} s", seconds);
    return fmt::format("{:.0f} s", seconds);
}

}  // namespace raypick
