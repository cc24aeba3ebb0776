#include "viewer/app/overlays.h"

#include "tracer/render/image.h"
#include "viewer/app/widgets.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace raypick {

namespace {

struct HelpLine {
    const char* what;
    const char* how;
};

constexpr HelpLine kHelp[] = {
    {"select an object", "click"},
    {"add or remove one", "Shift + click"},
    {"clear the selection", "click on the background, or Esc"},
    {"orbit", "drag, or Alt + drag"},
    {"pan", "Shift + drag, or middle drag"},
    {"zoom to the cursor", "wheel, or Alt + right drag"},
    {"frame the selection", "F"},
    {"frame everything", "Home"},
    {"ray trace the view, on and off", "R"},
    {"stop the ray tracer", "Esc"},
    {"open a file", "Ctrl + O, or drop it on the window"},
    {"save the picture", "Ctrl + S"},
    {"screenshot to the current folder", "F12"},
    {"show or hide the panels", "Tab"},
    {"this page", "F1 or H"},
    {"quit", "Ctrl + Q"},
};

void draw_body(HelpSheet& /*sheet*/, OverlayAnswer& answer) {
    if (ImGui::BeginTable("help", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const HelpLine& line : kHelp) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.what);
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", line.how);
        }
        ImGui::EndTable();
    }
    ImGui::Spacing();
    answer.close = draw_wide_button("Close");
}

void draw_body(MessageBox& box, OverlayAnswer& answer) {
    ImGui::PushTextWrapPos(30.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted(box.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    const bool enter = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter)) ||
                       ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter));
    answer.close = draw_wide_button("OK") || enter;
}

void draw_format_choice(std::string& name) {
    std::filesystem::path path(name);
    const std::string ending = path.extension().string();
    for (const char* format : {".png", ".exr"}) {
        const bool png = format[1] == 'p';
        if (ImGui::RadioButton(png ? "PNG" : "EXR (linear, all channels)", ending == format)) {
            name = path.replace_extension(format).string();
        }
        if (png) ImGui::SameLine();
    }
}

void draw_existing_note(const std::string& name) {
    std::error_code error;
    if (!name.empty() && std::filesystem::is_regular_file(name, error)) {
        draw_dim_text("This file exists and will be replaced.");
    }
}

std::string complaint_about(const PathDialog& dialog) {
    if (dialog.name.empty()) return "Give the file's name.";
    return dialog.purpose == PathDialog::Purpose::save ? save_complaint(dialog.name) : "";
}

void draw_body(PathDialog& dialog, OverlayAnswer& answer) {
    const bool saving = dialog.purpose == PathDialog::Purpose::save;
    if (!dialog.subject.empty()) draw_text(dialog.subject);
    ImGui::PushItemWidth(30.0f * ImGui::GetFontSize());
    if (dialog.fresh) ImGui::SetKeyboardFocusHere();
    dialog.fresh = false;
    bool confirmed =
        ImGui::InputText("##name", &dialog.name,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopItemWidth();
    if (saving) {
        draw_format_choice(dialog.name);
        draw_existing_note(dialog.name);
    }
    if (!dialog.complaint.empty()) draw_error_text(dialog.complaint);
    ImGui::Spacing();
    confirmed |= ImGui::Button(saving ? "Save" : "Open");
    ImGui::SameLine();
    answer.close = ImGui::Button("Cancel");
    if (confirmed) {
        dialog.complaint = complaint_about(dialog);
        if (dialog.complaint.empty()) answer.name = dialog.name;
    }
}

void draw_body(std::monostate& /*nothing*/, OverlayAnswer& /*answer*/) {}

std::string title_of(const Overlay& overlay) {
    struct Titles {
        std::string operator()(std::monostate) const { return ""; }
        std::string operator()(const HelpSheet&) const { return "Mouse and keys"; }
        std::string operator()(const MessageBox& box) const { return box.title; }
        std::string operator()(const PathDialog& dialog) const {
            return dialog.purpose == PathDialog::Purpose::save ? "Save the picture" : "Open a file";
        }
    };
    return std::visit(Titles{}, overlay);
}

}  // namespace

std::string save_complaint(const std::string& name) {
    const std::string complaint = unsupported_image_name(name);
    if (!complaint.empty()) return complaint;
    const std::filesystem::path folder = std::filesystem::path(name).parent_path();
    std::error_code error;
    if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
        return "There is no folder " + folder.string() + ".";
    }
    return "";
}

OverlayAnswer draw_overlay(Overlay& overlay) {
    OverlayAnswer answer;
    const bool open = !std::holds_alternative<std::monostate>(overlay);
    // One popup for all of them: what follows ### is its identity.
    const std::string title = title_of(overlay) + "###overlay";
    if (open && !ImGui::IsPopupOpen("###overlay")) ImGui::OpenPopup("###overlay");
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings;
    if (!ImGui::BeginPopupModal(title.c_str(), nullptr, kFlags)) return answer;
    std::visit([&](auto& content) { draw_body(content, answer); }, overlay);
    if (!open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return answer;
}

}  // namespace raypick
