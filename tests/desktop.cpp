#include "desktop.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace raypick {

namespace {

bool in_path(const std::string& program) {
    return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
}

std::string output_of(const std::string& command) {
    std::string output;
    FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("can't run " + command);
    char chunk[256];
    while (std::fgets(chunk, sizeof(chunk), pipe) != nullptr)
        output += chunk;
    ::pclose(pipe);
    while (!output.empty() && output.back() == '\n')
        output.pop_back();
    return output;
}

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

// One line from a pipe, at most `seconds` long; "" if none came.
std::string read_line(int descriptor, double seconds) {
    std::string line;
    char c = 0;
    pollfd readable{descriptor, POLLIN, 0};
    while (::poll(&readable, 1, static_cast<int>(1000 * seconds)) == 1 &&
           ::read(descriptor, &c, 1) == 1 && c != '\n') {
        line += c;
    }
    return line;
}

// A field of an XWD header: big endian.
std::size_t xwd_field(const std::string& file, std::size_t index) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value = value << 8 | static_cast<unsigned char>(file.at(4 * index + i));
    }
    return value;
}

}  // namespace

std::string missing_for_windows() {
    for (const char* program : {"Xvfb", "xdotool"}) {
        if (!in_path(program)) return std::string(program) + " is not installed";
    }
    return "";
}

Desktop::Desktop() {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    ::fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    const std::string number = std::to_string(ends[1]);
    const std::string screen = std::to_string(kWidth) + "x" + std::to_string(kHeight) + "x24";
    // The server chooses a free display itself and says which on the pipe.
    std::vector<std::string> words = {"Xvfb",
                                      "-displayfd",
                                      number,
                                      "-screen",
                                      "0",
                                      screen,
                                      "-nolisten",
                                      "tcp",
                                      "-noreset",
                                      "-fbdir",
                                      folder_.path().string()};
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int failure = ::posix_spawnp(&server_, "Xvfb", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    const std::string display = failure == 0 ? read_line(ends[0], 30.0) : "";
    ::close(ends[0]);
    if (display.empty()) throw std::runtime_error("Xvfb does not start");
    display_ = ":" + display;
}

Desktop::~Desktop() {
    if (server_ <= 0) return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
}

void Desktop::xdotool(const std::string& arguments) const {
    const std::string command = "DISPLAY=" + display_ + " xdotool " + arguments;
    if (std::system(command.c_str()) != 0) throw std::runtime_error(command + " failed");
}

std::string Desktop::xdotool_answer(const std::string& arguments) const {
    return output_of("DISPLAY=" + display_ + " xdotool " + arguments + " 2>/dev/null");
}

void Desktop::move(int x, int y) const {
    xdotool("mousemove " + std::to_string(x) + " " + std::to_string(y));
}

void Desktop::press(int button) const {
    xdotool("mousedown " + std::to_string(button));
}

void Desktop::release(int button) const {
    xdotool("mouseup " + std::to_string(button));
}

void Desktop::click(int x, int y, const std::string& modifier) const {
    move(x, y);
    if (modifier.empty()) {
        xdotool("click 1");
    } else {
        xdotool("keydown " + modifier + " click 1 keyup " + modifier);
    }
}

void Desktop::drag(int from_x, int from_y, int to_x, int to_y, int button) const {
    constexpr int kSteps = 5;
    move(from_x, from_y);
    press(button);
    for (int i = 1; i <= kSteps; ++i) {
        move(from_x + (to_x - from_x) * i / kSteps, from_y + (to_y - from_y) * i / kSteps);
    }
    release(button);
}

void Desktop::key(const std::string& combination) const {
    xdotool("key " + combination);
}

void Desktop::type(const std::string& text) const {
    xdotool("type " + quoted(text));
}

std::string Desktop::title() const {
    const std::string ids = xdotool_answer("search --onlyvisible --name '^raypick'");
    if (ids.empty()) return "";
    return xdotool_answer("getwindowname " + ids.substr(0, ids.find('\n')));
}

bool Desktop::wait_for_title(const std::string& wanted, double seconds) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < deadline) {
        if (title() == wanted) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
}

std::vector<Desktop::Colour> Desktop::screenshot() const {
    // The server keeps its frame buffer in this file, in the XWD format.
    const std::string file = read_file(folder_ / "Xvfb_screen0");
    constexpr std::size_t kHeaderSize = 0;
    constexpr std::size_t kBytesPerLine = 12;
    constexpr std::size_t kColours = 19;
    constexpr std::size_t kColourBytes = 12;
    const std::size_t start =
        xwd_field(file, kHeaderSize) + kColourBytes * xwd_field(file, kColours);
    const std::size_t line = xwd_field(file, kBytesPerLine);
    std::vector<Colour> pixels;
    for (std::size_t row = 0; row < kHeight; ++row) {
        for (std::size_t col = 0; col < kWidth; ++col) {
            const std::size_t at = start + row * line + 4 * col;
            const auto channel = [&](std::size_t i) {
                return static_cast<int>(static_cast<unsigned char>(file.at(at + i)));
            };
            pixels.push_back({channel(2), channel(1), channel(0)});
        }
    }
    return pixels;
}

bool Desktop::wait_for_change(const std::vector<Colour>& before, double seconds) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    std::vector<Colour> last = before;
    while (std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
        std::vector<Colour> now = screenshot();
        if (now == last && now != before) return true;
        last = std::move(now);
    }
    return false;
}

std::size_t Desktop::count_pixels(bool (*wanted)(const Colour&)) const {
    const std::vector<Colour> pixels = screenshot();
    return static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), wanted));
}

}  // namespace raypick
