// A line on the terminal that shows how far the work is.
#pragma once

#include <cstdint>
#include <string_view>

namespace raypick {

// Draws on standard error, and only if that is a terminal that can overwrite a line. In colour
// unless the environment says NO_COLOR. Removes its line when it goes.
class ProgressBar {
public:
    ProgressBar();
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    [[nodiscard]] bool visible() const { return visible_; }
    // `fraction` in [0, 1]; `doing` and `detail` are short texts before and behind the bar.
    void show(std::string_view doing, double fraction, std::string_view detail);
    // A line without a bar, for work whose end can't be foreseen.
    void show(std::string_view doing);
    void clear();

private:
    bool visible_ = false;
    bool colour_ = false;
    bool drawn_ = false;
};

}  // namespace raypick
