// An X server without a screen, on which windows of any program are watched for their first
// picture.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
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

    // The colours of a grid of points in the middle, where both our window and F3D's have the
    // model.
    using Picture = std::vector<std::uint32_t>;
    [[nodiscard]] Picture picture() const;

    // What it shows in the end: once it is not empty and has been still for so long.
    [[nodiscard]] Picture wait_until_still(double seconds) const;
    // Returns once nearly all of the picture is this one.
    void wait_for(const Picture& wanted) const;
    // Returns once no window is left.
    void wait_until_empty() const;

private:
    void map_frame_buffer(const std::string& file);
    static void wait_until(const std::function<bool()>& condition);

    pid_t server_ = -1;
    std::string display_;
    std::span<const unsigned char> frame_buffer_;  // the server's, in the XWD format
};

}  // namespace raypick::bench
