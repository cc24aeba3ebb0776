#include "viewer/app/input_state.h"

#include <algorithm>
#include <utility>

namespace raypick {

namespace {

// A dolly drag over the view's whole height is worth so many wheel steps.
constexpr double kDollySteps = 20.0;

double view_height_in_window_units(const CursorAt& at, const ViewRect& view) {
    return view.size.rows * at.window.window_height / at.window.framebuffer_rows;
}

bool has_area(const CursorAt& at, const ViewRect& view) {
    return view.size.rows > 0 && view.size.cols > 0 && at.window.window_height > 0 &&
           at.window.window_width > 0 && at.window.framebuffer_rows > 0;
}

}  // namespace

std::optional<Command> command_for(Key key, Modifiers modifiers) {
    if (modifiers.alt) return std::nullopt;
    if (modifiers.shift) {
        if (modifiers.control && key == Key::s) return Command::save_scene;
        return std::nullopt;
    }
    if (modifiers.control) {
        switch (key) {
            case Key::c:
                return Command::copy_view;
            case Key::one:
                return Command::view_back;
            case Key::three:
                return Command::view_left;
            case Key::seven:
                return Command::view_bottom;
            case Key::o:
                return Command::open;
            case Key::q:
                return Command::quit;
            case Key::s:
                return Command::save;
            default:
                return std::nullopt;
        }
    }
    switch (key) {
        case Key::f:
            return Command::frame_selected;
        case Key::home:
            return Command::frame_all;
        case Key::r:
            return Command::toggle_trace;
        case Key::one:
            return Command::view_front;
        case Key::three:
            return Command::view_right;
        case Key::five:
            return Command::toggle_projection;
        case Key::seven:
            return Command::view_top;
        case Key::escape:
            return Command::escape;
        case Key::enter:
            return Command::confirm;
        case Key::f1:
        case Key::h:
            return Command::toggle_help;
        case Key::tab:
            return Command::toggle_panels;
        case Key::f12:
            return Command::screenshot;
        default:
            return std::nullopt;
    }
}

bool UiRegion::contains(const Cursor& cursor) const {
    return cursor.x >= x && cursor.x < x + width && cursor.y >= y && cursor.y < y + height;
}

ImagePoint image_point_under(const CursorAt& at, const ViewRect& view) {
    return {at.cursor.y * at.window.framebuffer_rows / at.window.window_height - view.top_left.row,
            at.cursor.x * at.window.framebuffer_cols / at.window.window_width - view.top_left.col};
}

InputState::Drag InputState::drag_for(MouseButton button, Modifiers modifiers) {
    if (modifiers.control) return Drag::none;  // kept for selecting a rectangle
    switch (button) {
        case MouseButton::left:
            return modifiers.shift ? Drag::pan : Drag::orbit;
        case MouseButton::middle:
            return Drag::pan;
        case MouseButton::right:
            return modifiers.alt ? Drag::dolly : Drag::none;
    }
    return Drag::none;
}

bool InputState::over_ui(const Cursor& cursor) const {
    return screen_.modal || std::any_of(screen_.ui.begin(), screen_.ui.end(),
                                        [&](const UiRegion& r) { return r.contains(cursor); });
}

std::optional<Pixel> InputState::view_pixel(const CursorAt& at) const {
    if (over_ui(at.cursor)) return std::nullopt;
    return pixel_under(at.cursor, at.window, screen_.view);
}

void InputState::move(const CursorAt& to) {
    cursor_ = to;
    if (!clicks_.held()) return;
    clicks_.move(to.cursor);
    if (clicks_.dragging()) drag_to(to);
}

void InputState::leave() {
    cursor_.reset();
}

void InputState::press(MouseButton button, const CursorAt& at, Modifiers modifiers) {
    cursor_ = at;
    if (clicks_.held() && clicks_.held() != button) {
        clicks_.press(button, at.cursor, false);  // one drag at a time; this one is no click now
        return;
    }
    const std::optional<Pixel> pixel = view_pixel(at);
    if (!pixel) {
        ui_pressed_ = button;
        return;
    }
    clicks_.press(button, at.cursor, true);
    pressed_pixel_ = pixel;
    drag_ = drag_for(button, modifiers);
    dragged_from_ = at;
}

void InputState::release(MouseButton button, const CursorAt& at, Modifiers modifiers) {
    cursor_ = at;
    if (ui_pressed_ == button) ui_pressed_.reset();
    if (clicks_.held() != button) return;
    if (clicks_.dragging()) drag_to(at);
    const bool clicked = clicks_.release(button, at.cursor).has_value();
    const bool selects = button == MouseButton::left && !modifiers.control && !modifiers.alt;
    if (clicked && selects && pressed_pixel_) {
        actions_.emplace_back(ClickAction{*pressed_pixel_, modifiers.shift});
    }
    drag_ = Drag::none;
    pressed_pixel_.reset();
}

void InputState::wheel(double steps, const CursorAt& at) {
    cursor_ = at;
    if (steps == 0.0 || ui_pressed_ || !view_pixel(at)) return;
    add(ZoomAction{steps, image_point_under(at, screen_.view)});
}

void InputState::key(Key key, Modifiers modifiers) {
    const std::optional<Command> command = command_for(key, modifiers);
    if (!command) return;
    const bool confirms = screen_.modal && command == Command::confirm;
    const bool always = confirms || command == Command::quit || command == Command::escape;
    if (screen_.typing && !always) return;
    if (screen_.modal && !always && command != Command::toggle_help) return;
    if (command == Command::confirm && !confirms) return;
    actions_.emplace_back(*command);
}

void InputState::drop(std::span<const std::filesystem::path> files) {
    // A scene is one file; of several the last one counts, as if they were opened in turn.
    if (!files.empty()) actions_.emplace_back(OpenAction{files.back()});
}

void InputState::lose_focus() {
    clicks_.cancel();
    ui_pressed_.reset();
    pressed_pixel_.reset();
    drag_ = Drag::none;
}

std::vector<InputAction> InputState::take_actions() {
    return std::exchange(actions_, {});
}

std::optional<Pixel> InputState::hover() const {
    if (!cursor_ || ui_pressed_ || clicks_.held()) return std::nullopt;
    return view_pixel(*cursor_);
}

void InputState::drag_to(const CursorAt& to) {
    const CursorAt from = std::exchange(dragged_from_, to);
    if (!has_area(to, screen_.view)) return;
    const double height = view_height_in_window_units(to, screen_.view);
    const double right = (to.cursor.x - from.cursor.x) / height;
    const double down = (to.cursor.y - from.cursor.y) / height;
    switch (drag_) {
        case Drag::none:
            break;
        case Drag::orbit:
            add(OrbitAction{right, down});
            break;
        case Drag::pan:
            add(PanAction{image_point_under(from, screen_.view),
                          image_point_under(to, screen_.view)});
            break;
        case Drag::dolly:
            add(ZoomAction{kDollySteps * (right - down), std::nullopt});
            break;
    }
}

void InputState::add(const OrbitAction& orbit) {
    auto* last = actions_.empty() ? nullptr : std::get_if<OrbitAction>(&actions_.back());
    if (last == nullptr) {
        actions_.emplace_back(orbit);
        return;
    }
    last->right += orbit.right;
    last->down += orbit.down;
}

void InputState::add(const PanAction& pan) {
    auto* last = actions_.empty() ? nullptr : std::get_if<PanAction>(&actions_.back());
    if (last == nullptr) {
        actions_.emplace_back(pan);
        return;
    }
    last->to = pan.to;
}

void InputState::add(const ZoomAction& zoom) {
    auto* last = actions_.empty() ? nullptr : std::get_if<ZoomAction>(&actions_.back());
    const bool same_place = last != nullptr && last->at.has_value() == zoom.at.has_value() &&
                            (!zoom.at || (last->at->r == zoom.at->r && last->at->c == zoom.at->c));
    if (!same_place) {
        actions_.emplace_back(zoom);
        return;
    }
    last->steps += zoom.steps;
}

}  // namespace raypick
