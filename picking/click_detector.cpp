#include "picking/click_detector.h"

#include <cmath>

namespace raypick {

void ClickDetector::press(MouseButton button, Cursor at, bool inside_view) {
    if (pressed_ && *pressed_ != button) {
        chorded_ = true;
        return;
    }
    cancel();  // a press of the button that is down already: its release got lost
    if (!inside_view) return;
    pressed_ = button;
    start_ = at;
}

void ClickDetector::move(Cursor to) {
    if (!pressed_) return;
    // Not "> kSlop", so that a NaN is no click.
    if (!(std::hypot(to.x - start_.x, to.y - start_.y) <= kSlop)) dragged_ = true;
}

std::optional<Cursor> ClickDetector::release(MouseButton button, Cursor at) {
    if (!pressed_ || *pressed_ != button) return std::nullopt;
    move(at);
    const bool clicked = !dragged_ && !chorded_;
    const Cursor start = start_;
    cancel();
    if (!clicked) return std::nullopt;
    return start;
}

void ClickDetector::cancel() {
    pressed_.reset();
    dragged_ = false;
    chorded_ = false;
}

}  // namespace raypick
