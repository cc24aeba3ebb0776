// An X server without a screen, and a hand for its mouse and keyboard, for window tests.
#pragma once

#include "program.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace raypick {

// "" if window tests can run here, else what is missing.
std::string missing_for_windows();

class Desktop {
public:
    static constexpr int kWidth = 1400;
    static constexpr int kHeight = 1000;

    Desktop();  // throws std::runtime_error if the server does not start
    ~Desktop();
    Desktop(const Desktop&) = delete;
    Desktop& operator=(const Desktop&) = delete;

    [[nodiscard]] const std::string& display() const { return display_; }

    // Positions are on the screen; there is no window manager, so a window's corner is at (0, 0).
    void move(int x, int y) const;
    void press(int button = 1) const;
    void release(int button = 1) const;
    // `modifier` as xdotool names it ("shift"); "": none.
    void click(int x, int y, const std::string& modifier = "") const;
    void drag(int from_x, int from_y, int to_x, int to_y, int button = 1) const;
    void key(const std::string& combination) const;
    void type(const std::string& text) const;

    // The title of the one visible window whose title begins with "raypick"; "" if there is none.
    [[nodiscard]] std::string title() const;
    // True once that title is this one.
    [[nodiscard]] bool wait_for_title(const std::string& wanted, double seconds = 60.0) const;

    // What the screen shows.
    struct Colour {
        int red = 0;
        int green = 0;
        int blue = 0;

        friend bool operator==(const Colour&, const Colour&) = default;
    };
    [[nodiscard]] std::vector<Colour> screenshot() const;  // row-major
    // True once the screen shows something else than `before` (empty: anything) and keeps still.
    [[nodiscard]] bool wait_for_change(const std::vector<Colour>& before,
                                       double seconds = 60.0) const;
    [[nodiscard]] std::size_t count_pixels(bool (*wanted)(const Colour&)) const;

private:
    void xdotool(const std::string& arguments) const;
    [[nodiscard]] std::string xdotool_answer(const std::string& arguments) const;

    TemporaryFolder folder_;  // holds the server's frame buffer
    pid_t server_ = -1;
    std::string display_;
};

}  // namespace raypick
