// Finds out whether a window can be opened, without hanging on a display that does not answer.
#include "viewer/app/view.h"

#include <GLFW/glfw3.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace raypick {

namespace {

constexpr std::chrono::seconds kPatience{5};

bool display_named() {
    for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY"}) {
        const char* value = std::getenv(variable);
        if (value != nullptr && *value != '\0') return true;
    }
    return false;
}

void silence() {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere < 0) return;
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
}

[[noreturn]] void try_to_open_a_window() {
    silence();
    if (glfwInit() != GLFW_TRUE) _exit(1);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    _exit(glfwCreateWindow(64, 64, "raypick", nullptr, nullptr) != nullptr ? 0 : 1);
}

bool succeeds_in_time(pid_t child) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > deadline) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

bool display_answers() {
    if (!display_named()) return false;
    // Opening a display blocks for as long as its server is silent, so a child process tries it.
    const pid_t child = fork();
    if (child < 0) return false;
    if (child == 0) try_to_open_a_window();
    return succeeds_in_time(child);
}

}  // namespace raypick
