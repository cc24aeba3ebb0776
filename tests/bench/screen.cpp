#include "tests/bench/screen.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace raypick::bench {

namespace {

// Its standard output and error go nowhere. Throws std::runtime_error.
pid_t start(std::vector<std::string> words, const std::string& display) {
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    std::string variable = "DISPLAY=" + display;
    std::vector<char*> environment{variable.data()};
    for (char** v = environ; *v != nullptr; ++v) {
        if (std::strncmp(*v, "DISPLAY=", 8) != 0) environment.push_back(*v);
    }
    environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t process = -1;
    const int failure =
        ::posix_spawnp(&process, argv[0], &actions, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) throw std::runtime_error(fmt::format("can't start {}", words[0]));
    return process;
}

// A line that comes through a pipe within half a minute; "" if none does.
std::string read_line(int descriptor) {
    std::string line;
    char c = 0;
    pollfd readable{descriptor, POLLIN, 0};
    while (::poll(&readable, 1, 30'000) == 1 && ::read(descriptor, &c, 1) == 1 && c != '\n')
        line += c;
    return line;
}

// A field of an XWD header: big endian.
std::size_t xwd_field(std::span<const unsigned char> file, std::size_t index) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8u | file[4 * index + i];
    return value;
}

// One colour: no window, or nothing in it.
bool is_empty(const Screen::Picture& picture) {
    return std::count(picture.begin(), picture.end(), picture.front()) ==
           static_cast<std::ptrdiff_t>(picture.size());
}

void end(pid_t process, int signal) {
    if (process <= 0) return;
    ::kill(process, signal);
    ::waitpid(process, nullptr, 0);
}

}  // namespace

Child::Child(std::vector<std::string> words, const std::string& display)
    : process_(start(std::move(words), display)) {}

Child::~Child() {
    end(process_, SIGKILL);
}

Screen::Screen() {
    const std::filesystem::path folder = std::filesystem::absolute("bench-screen");
    std::filesystem::create_directories(folder);
    int ends[2] = {-1, -1};
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    ::fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    // The server chooses a free display itself and says which on the pipe.
    server_ = start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0",
                     fmt::format("{}x{}x24", kCols, kRows), "-nolisten", "tcp", "-noreset",
                     "-fbdir", folder.string()},
                    "");
    ::close(ends[1]);
    display_ = ":" + read_line(ends[0]);
    ::close(ends[0]);
    if (display_ == ":") throw std::runtime_error("Xvfb does not start");
    map_frame_buffer((folder / "Xvfb_screen0").string());
}

Screen::~Screen() {
    if (!frame_buffer_.empty()) {
        ::munmap(const_cast<unsigned char*>(frame_buffer_.data()),  // NOLINT: as mmap gave it
                 frame_buffer_.size());
    }
    end(server_, SIGTERM);
}

void Screen::map_frame_buffer(const std::string& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
        throw std::runtime_error("Xvfb has no frame buffer");
    }
    const auto size = static_cast<std::size_t>(status.st_size);
    void* memory = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    if (memory == MAP_FAILED) throw std::runtime_error("Xvfb's frame buffer can't be seen");
    frame_buffer_ = {static_cast<const unsigned char*>(memory), size};
}

Screen::Picture Screen::picture() const {
    constexpr std::size_t kHeaderSize = 0;
    constexpr std::size_t kBytesPerLine = 12;
    constexpr std::size_t kColours = 19;
    constexpr std::size_t kColourBytes = 12;
    constexpr std::size_t kPoints = 24;
    const std::size_t begin =
        xwd_field(frame_buffer_, kHeaderSize) + kColourBytes * xwd_field(frame_buffer_, kColours);
    const std::size_t line = xwd_field(frame_buffer_, kBytesPerLine);
    Picture points(kPoints * kPoints);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t row = kRows / 4 + i / kPoints * (kRows / 2) / kPoints;
        const std::size_t col = kCols / 5 + i % kPoints * (kCols * 2 / 5) / kPoints;
        std::memcpy(&points[i], &frame_buffer_[begin + row * line + 4 * col], sizeof(points[i]));
    }
    return points;
}

void Screen::wait_until(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) {
            throw std::runtime_error("the screen doesn't show what it should");
        }
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
}

Screen::Picture Screen::wait_until_still(double seconds) const {
    using Clock = std::chrono::steady_clock;
    Picture last = picture();
    Clock::time_point since = Clock::now();
    wait_until([&] {
        Picture now = picture();
        if (now != last || is_empty(now)) {
            last = std::move(now);
            since = Clock::now();
        }
        return std::chrono::duration<double>(Clock::now() - since).count() > seconds;
    });
    return last;
}

void Screen::wait_for(const Picture& wanted) const {
    wait_until([&] {
        const Picture now = picture();
        std::size_t same = 0;
        for (std::size_t i = 0; i < now.size(); ++i)
            same += now[i] == wanted[i] ? 1 : 0;
        return 20 * same >= 19 * now.size();
    });
}

void Screen::wait_until_empty() const {
    wait_until([this] { return is_empty(picture()); });
}

}  // namespace raypick::bench
