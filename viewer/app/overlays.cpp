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
    {"front, right, top (Ctrl: opposite)", "1, 3, 7"},
    {"orthographic, on and off", "5"},
    {"copy the view as command-line options", "Ctrl + C"},
    {"ray trace the view, on and off", "R"},
    {"stop the ray tracer", "Esc"},
    {"open a file", "Ctrl + O, or drop it on the window"},
    {"save the picture", "Ctrl + S"},
    {"save the scene as JSON", "Ctrl + Shift + S"},
    {"screenshot to the current folder", "F12"},
    {"show or hide the panels", "Tab"},
    {"this page", "F1 or H"},
    {"quit", "Ctrl + Q"},
};

void draw_body(HelpSheet& /*sheet*/, bool confirm, OverlayAnswer& answer) {
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
    answer.close = draw_wide_button("Close") || confirm;
}

void draw_body(MessageBox& box, bool confirm, OverlayAnswer& answer) {
    draw_text(box.text);
    ImGui::Spacing();
    answer.close = draw_wide_button("OK") || confirm;
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
    switch (dialog.purpose) {
        case PathDialog::Purpose::save_picture:
            return save_complaint(dialog.name);
        case PathDialog::Purpose::save_scene:
            return scene_complaint(dialog.name);
        case PathDialog::Purpose::open:
            break;
    }
    return "";
}

void draw_body(PathDialog& dialog, bool confirm, OverlayAnswer& answer) {
    const bool saving = dialog.purpose != PathDialog::Purpose::open;
    if (!dialog.subject.empty()) draw_text(dialog.subject);
    ImGui::PushItemWidth(-1.0f);
    if (dialog.wants_keyboard) ImGui::SetKeyboardFocusHere();
    dialog.wants_keyboard = false;
    ImGui::InputText("##name", &dialog.name, ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopItemWidth();
    if (saving) {
        if (dialog.purpose == PathDialog::Purpose::save_picture) draw_format_choice(dialog.name);
        draw_existing_note(dialog.name);
    }
    if (!dialog.complaint.empty()) draw_error_text(dialog.complaint);
    ImGui::Spacing();
    const bool confirmed = ImGui::Button(saving ? "Save" : "Open") || confirm;
    ImGui::SameLine();
    answer.close = ImGui::Button("Cancel");
    if (confirmed) {
        dialog.complaint = complaint_about(dialog);
        if (dialog.complaint.empty()) answer.name = dialog.name;
        dialog.wants_keyboard = true;  // which Enter took from the name
    }
}

void draw_body(std::monostate& /*nothing*/, bool /*confirm*/, OverlayAnswer& /*answer*/) {}

std::string title_of(const Overlay& overlay) {
    struct Titles {
        std::string operator()(std::monostate) const { return ""; }
        std::string operator()(const HelpSheet&) const { return "Mouse and keys"; }
        std::string operator()(const MessageBox& box) const { return box.title; }
        std::string operator()(const PathDialog& dialog) const {
            switch (dialog.purpose) {
                case PathDialog::Purpose::save_picture:
                    return "Save the picture";
                case PathDialog::Purpose::save_scene:
                    return "Save the scene";
                case PathDialog::Purpose::open:
                    break;
            }
            return "Open a file";
        }
    };
    return std::visit(Titles{}, overlay);
}

std::string folder_complaint(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(name).parent_path();
    std::error_code error;
    if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
        return "There is no folder " + folder.string() + ".";
    }
    return "";
}

}  // namespace

std::string save_complaint(const std::string& name) {
    std::string complaint = unsupported_image_name(name);
    return complaint.empty() ? folder_complaint(name) : complaint;
}

std::string scene_complaint(const std::string& name) {
    // A scene that is called .obj would be read as one.
    if (std::filesystem::path(name).extension() != ".json") return "The name must end in .json.";
    return folder_complaint(name);
}

OverlayAnswer draw_overlay(Overlay& overlay, bool confirm) {
    OverlayAnswer answer;
    const bool open = !std::holds_alternative<std::monostate>(overlay);
    // One popup for all of them: what follows ### is its identity.
    const std::string title = title_of(overlay) + "###overlay";
    if (open && !ImGui::IsPopupOpen("###overlay")) ImGui::OpenPopup("###overlay");
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    // As high as its content.
    const float width = std::min(34.0f * ImGui::GetFontSize(), 0.95f * screen.x);
    ImGui::SetNextWindowSize(ImVec2(width, 0.0f));
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings;
    // A popup can only be closed from inside, in a frame that must not show it empty.
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, open ? 1.0f : 0.0f);
    if (ImGui::BeginPopupModal(title.c_str(), nullptr, kFlags)) {
        std::visit([&](auto& content) { draw_body(content, confirm, answer); }, overlay);
        if (!open) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
    return answer;
}

}  // namespace raypick
