// Tells a click from a drag.
#pragma once

#include "picking/cursor.h"

#include <optional>

namespace raypick {

enum class MouseButton { left, middle, right };

// Feed it every press, move and release that the UI did not take. A click is a press inside the
// view and a release of the same button, the cursor never having been farther than kSlop window
// units from the press and no other button pressed meanwhile. Anything else is a drag, also when it
// ends where it began.
class ClickDetector {
public:
    static constexpr double kSlop = 4.0;  // window units

    void press(MouseButton button, Cursor at, bool inside_view);
    void move(Cursor to);
    // Where the click happened: the press position; nothing if this release ends a drag.
    std::optional<Cursor> release(MouseButton button, Cursor at);
    // Forget a press: the window lost focus, the UI took over.
    void cancel();

    // A button is down and was moved beyond the slop.
    [[nodiscard]] bool dragging() const { return pressed_.has_value() && dragged_; }
    // The button of a press that began in the view and has not ended.
    [[nodiscard]] std::optional<MouseButton> held() const { return pressed_; }

private:
    std::optional<MouseButton> pressed_;
    Cursor start_;
    bool dragged_ = false;
    bool chorded_ = false;  // another button went down meanwhile
};

}  // namespace raypick
