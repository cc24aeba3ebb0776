#include "viewer/cli/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace raypick {
namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

int terminal_columns() {
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

constexpr std::string_view kClearLine = "\r\x1b[K";

void print(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar()
    : visible_(isatty(STDERR_FILENO) == 1 && environment("TERM") != "dumb"),
      colour_(environment("NO_COLOR").empty()) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::show(std::string_view doing, double fraction, std::string_view detail) {
    if (!visible_) return;
    const int text_width = static_cast<int>(doing.size() + detail.size()) + 12;
    const int width = std::clamp(terminal_columns() - text_width, 0, 50);
    const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
    const std::string bar(static_cast<std::size_t>(filled), '=');
    print(fmt::format("{}{} [{}{}{}{:{}}] {:3.0f} % {}", kClearLine, doing,
                      colour_ ? "\x1b[32m" : "", bar, colour_ ? "\x1b[0m" : "", "", width - filled,
                      100.0 * fraction, detail));
    drawn_ = true;
}

void ProgressBar::show(std::string_view doing) {
    if (!visible_) return;
    print(fmt::format("{}{} ...", kClearLine, doing));
    drawn_ = true;
}

void ProgressBar::clear() {
    if (drawn_) print(kClearLine);
    drawn_ = false;
}

}  // namespace raypick
