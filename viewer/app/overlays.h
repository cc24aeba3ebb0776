// Dialogs over the window: one at a time, the rest of the window waits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

namespace raypick {

// Keys and mouse on one page.
struct HelpSheet {};

// Something the person must know before going on.
struct MessageBox {
    std::string title;
    std::string text;
};

// Asks for a file's name.
struct PathDialog {
    enum class Purpose { open, save_picture, save_scene };

    Purpose purpose = Purpose::open;
    std::string name;
    std::string subject;  // of what is saved: what it holds
    std::string complaint;
    bool wants_keyboard = true;  // for its name, in the next frame
};

using Overlay = std::variant<std::monostate, HelpSheet, MessageBox, PathDialog>;

struct OverlayAnswer {
    bool close = false;
    std::optional<std::string> name;  // the path dialog was confirmed with it
};

// Draws what is open, if anything. Call in every frame, so that what was closed goes away.
// `confirm`: Enter was pressed.
OverlayAnswer draw_overlay(Overlay& overlay, bool confirm);

// "" if a picture can be written to that name, else why not.
std::string save_complaint(const std::string& name);

// The same of a scene, which is written as JSON.
std::string scene_complaint(const std::string& name);

}  // namespace raypick
