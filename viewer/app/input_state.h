// From raw mouse and key events to what a person asked for. No window and no UI library: events go
// in as numbers, actions come out in their order, so that all of it can be tested.
#pragma once

#include "picking/click_detector.h"
#include "picking/cursor.h"
#include "tracer/geometry/pixel.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace raypick {

// What keys and buttons can ask for.
enum class Command {
    frame_selected,
    frame_all,
    toggle_trace,
    toggle_projection,
    view_front,
    view_back,
    view_right,
    view_left,
    view_top,
    view_bottom,
    copy_view,  // as options of the command line, to the clipboard
    escape,     // close what is open, else stop the render, else clear the selection
    confirm,    // what a dialog asks
    toggle_help,
    toggle_panels,
    open,
    save,        // the picture
    save_scene,  // as JSON
    screenshot,
    quit
};

// The keys that mean something to us. Letters are those printed on the keyboard, not positions.
enum class Key { c, f, h, o, q, r, s, one, three, five, seven, enter, escape, f1, f12, home, tab };

struct Modifiers {
    bool shift = false;
    bool control = false;
    bool alt = false;
};

// The command of a key; nothing if the combination has none.
std::optional<Command> command_for(Key key, Modifiers modifiers);

// The cursor moved by so much while orbiting, in heights of the view.
struct OrbitAction {
    double right = 0.0;
    double down = 0.0;
};

// What was under `from` shall be under `to`: points of the view, possibly outside it.
struct PanAction {
    ImagePoint from;
    ImagePoint to;
};

// Nearer by so many wheel steps (negative: farther), towards a point of the view; nothing: towards
// its centre.
struct ZoomAction {
    double steps = 0.0;
    std::optional<ImagePoint> at;
};

struct ClickAction {
    Pixel pixel;
    bool add = false;  // to the selection (Shift)
};

struct OpenAction {
    std::filesystem::path file;
};

using InputAction =
    std::variant<OrbitAction, PanAction, ZoomAction, ClickAction, OpenAction, Command>;

// The cursor and how window and framebuffer related when the event happened.
struct CursorAt {
    Cursor cursor;
    WindowMetrics window;
};

// A rectangle that the UI covers, window units.
struct UiRegion {
    double x = 0.0;
    double y = 0.0;
    double width = 0.0;
    double height = 0.0;

    [[nodiscard]] bool contains(const Cursor& cursor) const;
};

// What the last drawn frame looked like: events are judged by what the person saw.
struct ScreenState {
    ViewRect view;
    std::vector<UiRegion> ui;
    bool modal = false;   // a dialog is open: the mouse is the UI's
    bool typing = false;  // a text field has the keyboard
};

// The real image point of the view under the cursor; may lie outside the view.
ImagePoint image_point_under(const CursorAt& at, const ViewRect& view);

class InputState {
public:
    void set_screen(ScreenState screen) { screen_ = std::move(screen); }

    void move(const CursorAt& to);
    void leave();
    void press(MouseButton button, const CursorAt& at, Modifiers modifiers);
    void release(MouseButton button, const CursorAt& at, Modifiers modifiers);
    void wheel(double steps, const CursorAt& at);
    void key(Key key, Modifiers modifiers);
    void drop(std::span<const std::filesystem::path> files);
    void lose_focus();

    // What was asked for since the last call. Movements of one kind in a row come as one.
    std::vector<InputAction> take_actions();
    // The pixel that the cursor rests on, if it is on the view and no button is down.
    [[nodiscard]] std::optional<Pixel> hover() const;

private:
    enum class Drag { none, orbit, pan, dolly };

    static Drag drag_for(MouseButton button, Modifiers modifiers);
    [[nodiscard]] bool over_ui(const Cursor& cursor) const;
    [[nodiscard]] std::optional<Pixel> view_pixel(const CursorAt& at) const;
    void drag_to(const CursorAt& to);
    void add(const OrbitAction& orbit);
    void add(const PanAction& pan);
    void add(const ZoomAction& zoom);

    ScreenState screen_;
    ClickDetector clicks_;
    std::vector<InputAction> actions_;
    std::optional<CursorAt> cursor_;         // nothing: outside the window
    std::optional<MouseButton> ui_pressed_;  // a button that went down on the UI
    std::optional<Pixel> pressed_pixel_;
    Drag drag_ = Drag::none;
    CursorAt dragged_from_;
};

}  // namespace raypick
