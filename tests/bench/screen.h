// An X server without a screen, on which windows of any program are watched for their first
// picture.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace raypick::bench {

// A program that was started; killed, if it still runs, when this goes.
class Child {
public:
    // Words as for a shell, found in PATH; its output goes nowhere. `display` as in ":1".
    Child(std::vector<std::string> words, const std::string& display);
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

private:
    pid_t process_ = -1;
};

class Screen {
public:
    static constexpr int kCols = 1000;
    static constexpr int kRows = 600;

    Screen();  // throws std::runtime_error if the server doesn't start
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    [[nodiscard]] const std::string& display() const { return display_; }

    // True if its middle shows something shaded: a grid of 16 x 16 points there has a dozen
    // colours or more. An empty window has one, one with a word in it a few.
    [[nodiscard]] bool shows_picture() const;
    // Returns once the screen is (not) showing a picture; throws std::runtime_error after a minute.
    void wait_for_picture(bool shown) const;

private:
    void map_frame_buffer(const std::string& file);

    pid_t server_ = -1;
    std::string display_;
    std::span<const unsigned char> frame_buffer_;  // the server's, in the XWD format
};

}  // namespace raypick::bench
