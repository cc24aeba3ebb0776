#include "viewer/app/display.h"

#include "viewer/app/view.h"

#include <GLFW/glfw3.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <utility>

namespace raypick {

namespace {

constexpr int kPatienceMilliseconds = 5000;
constexpr std::chrono::milliseconds kBeforeSecondTry{150};
constexpr char kAnswer = '1';

bool display_named() {
    constexpr std::array kVariables{"DISPLAY", "WAYLAND_DISPLAY"};
    return std::ranges::any_of(kVariables, [](const char* variable) {
        const char* value = std::getenv(variable);
        return value != nullptr && *value != '\0';
    });
}

void silence() {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere < 0) return;
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
}

bool opens_a_window() {
    if (glfwInit() != GLFW_TRUE) return false;
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    return glfwCreateWindow(64, 64, "raypick", nullptr, nullptr) != nullptr;
}

// The whole life of the child. It never returns into the program, whose exit handlers are not its
// own.
[[noreturn]] void live_as_child(int to_parent, pid_t parent) {
    silence();
    if (!opens_a_window() || write(to_parent, &kAnswer, 1) != 1) _exit(1);
    // The parent ends it; should the parent be gone, nobody would.
    while (getppid() == parent)
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    _exit(0);
}

}  // namespace

DisplayProbe::DisplayProbe() {
    if (display_named()) start();
}

DisplayProbe::~DisplayProbe() {
    stop();
}

void DisplayProbe::ask_again() {
    stop();
    std::this_thread::sleep_for(kBeforeSecondTry);
    start();
}

void DisplayProbe::start() {
    outcome_ = Outcome::unknown;
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    const pid_t parent = getpid();
    child_ = fork();
    if (child_ == 0) {
        close(ends[0]);
        live_as_child(ends[1], parent);
    }
    close(ends[1]);
    from_child_ = ends[0];
}

DisplayProbe::Outcome DisplayProbe::outcome() {
    if (outcome_ == Outcome::unknown) outcome_ = asks() ? hear() : Outcome::refuses;
    return outcome_;
}

DisplayProbe::Outcome DisplayProbe::hear() const {
    pollfd readable{from_child_, POLLIN, 0};
    if (poll(&readable, 1, kPatienceMilliseconds) != 1) return Outcome::silent;
    char answer = 0;
    const bool heard = read(from_child_, &answer, 1) == 1 && answer == kAnswer;
    return heard ? Outcome::answers : Outcome::refuses;
}

void DisplayProbe::stop() {
    if (child_ > 0) {
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
        child_ = -1;
    }
    if (from_child_ >= 0) close(std::exchange(from_child_, -1));
}

bool display_answers() {
    DisplayProbe probe;
    if (probe.refuses()) probe.ask_again();
    return probe.answers();
}

}  // namespace raypick
