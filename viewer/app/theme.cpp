#include "viewer/app/theme.h"

#include <imgui.h>

#include <cmath>
#include <filesystem>

namespace raypick {

namespace {

ImVec4 grey(float level, float alpha = 1.0f) {
    return {level, level * 1.02f, level * 1.06f, alpha};
}

const ImVec4 kAccent{0.96f, 0.55f, 0.13f, 1.0f};

ImVec4 accent(float strength) {
    return {kAccent.x * strength, kAccent.y * strength, kAccent.z * strength, 1.0f};
}

void set_surfaces(ImVec4* colours) {
    colours[ImGuiCol_Text] = grey(0.90f);
    colours[ImGuiCol_TextDisabled] = grey(0.62f);
    colours[ImGuiCol_WindowBg] = grey(0.115f);
    colours[ImGuiCol_PopupBg] = grey(0.145f);
    colours[ImGuiCol_Border] = grey(0.26f);
    colours[ImGuiCol_FrameBg] = grey(0.20f);
    colours[ImGuiCol_FrameBgHovered] = grey(0.26f);
    colours[ImGuiCol_FrameBgActive] = grey(0.30f);
    colours[ImGuiCol_TitleBg] = grey(0.17f);
    colours[ImGuiCol_TitleBgActive] = grey(0.20f);
    colours[ImGuiCol_ScrollbarBg] = grey(0.115f);
    colours[ImGuiCol_ScrollbarGrab] = grey(0.32f);
    colours[ImGuiCol_Separator] = grey(0.24f);
    colours[ImGuiCol_ModalWindowDimBg] = {0.0f, 0.0f, 0.0f, 0.45f};
}

void set_controls(ImVec4* colours) {
    colours[ImGuiCol_Button] = grey(0.25f);
    colours[ImGuiCol_ButtonHovered] = grey(0.32f);
    colours[ImGuiCol_ButtonActive] = grey(0.38f);
    colours[ImGuiCol_Header] = grey(0.19f);
    colours[ImGuiCol_HeaderHovered] = grey(0.25f);
    colours[ImGuiCol_HeaderActive] = grey(0.30f);
    colours[ImGuiCol_CheckMark] = kAccent;
    colours[ImGuiCol_SliderGrab] = accent(0.85f);
    colours[ImGuiCol_SliderGrabActive] = kAccent;
    colours[ImGuiCol_PlotHistogram] = accent(0.62f);
    colours[ImGuiCol_TextSelectedBg] = accent(0.45f);
    colours[ImGuiCol_NavHighlight] = kAccent;
}

// A proportional font with many scripts where Debian's usual one is installed; ImGui's built-in
// one, which knows Latin letters only, everywhere else.
void load_font(float pixels) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    const char* file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) {
        static constexpr ImWchar kRanges[] = {0x20,   0x24f,  0x370,  0x52f, 0x2010,
                                              0x2026, 0x2190, 0x2193, 0};
        const float size = std::round(14.0f * pixels);
        if (atlas.AddFontFromFileTTF(file, size, nullptr, kRanges) != nullptr) return;
    }
    ImFontConfig config;
    config.SizePixels = std::round(13.0f * pixels);
    atlas.AddFontDefault(&config);
}

}  // namespace

void apply_theme(double ui_scale, double density) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    set_surfaces(style.Colors);
    set_controls(style.Colors);
    style.WindowPadding = {12.0f, 10.0f};
    style.FramePadding = {8.0f, 4.0f};
    style.ItemSpacing = {8.0f, 6.0f};
    style.FrameRounding = 4.0f;
    style.PopupRounding = 6.0f;
    style.GrabRounding = 3.0f;
    style.ScrollbarSize = 12.0f;
    style.WindowBorderSize = 1.0f;
    style.ScaleAllSizes(static_cast<float>(ui_scale));
    ImGui::GetStyle() = style;
    load_font(static_cast<float>(ui_scale * density));
    ImGui::GetIO().FontGlobalScale = static_cast<float>(1.0 / density);
}

}  // namespace raypick
