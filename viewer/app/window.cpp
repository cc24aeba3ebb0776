#include "viewer/app/window.h"

// Before GLFW: it stands in for the system's GL headers.
#include "viewer/gl/load_gl.h"

#include <GLFW/glfw3.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace raypick {

namespace {

std::string glfw_complaint() {
    const char* description = nullptr;
    const int code = glfwGetError(&description);
    return code == GLFW_NO_ERROR || description == nullptr ? "unknown reason" : description;
}

std::optional<MouseButton> mouse_button(int button) {
    switch (button) {
        case GLFW_MOUSE_BUTTON_LEFT:
            return MouseButton::left;
        case GLFW_MOUSE_BUTTON_MIDDLE:
            return MouseButton::middle;
        case GLFW_MOUSE_BUTTON_RIGHT:
            return MouseButton::right;
        default:
            return std::nullopt;
    }
}

Modifiers modifiers_of(int mods) {
    return {(mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0,
            (mods & GLFW_MOD_ALT) != 0};
}

std::optional<Key> letter_key(char letter) {
    switch (letter) {
        case 'c':
            return Key::c;
        case 'f':
            return Key::f;
        case 'h':
            return Key::h;
        case 'o':
            return Key::o;
        case 'q':
            return Key::q;
        case 'r':
            return Key::r;
        case 's':
            return Key::s;
        default:
            return std::nullopt;
    }
}

std::optional<Key> key_of(int key, int scancode) {
    switch (key) {
        case GLFW_KEY_HOME:
            return Key::home;
        case GLFW_KEY_ESCAPE:
            return Key::escape;
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER:
            return Key::enter;
        case GLFW_KEY_TAB:
            return Key::tab;
        case GLFW_KEY_F1:
            return Key::f1;
        case GLFW_KEY_F12:
            return Key::f12;
        // Digits by their place: many keyboards want Shift for those in the row.
        case GLFW_KEY_1:
        case GLFW_KEY_KP_1:
            return Key::one;
        case GLFW_KEY_3:
        case GLFW_KEY_KP_3:
            return Key::three;
        case GLFW_KEY_5:
        case GLFW_KEY_KP_5:
            return Key::five;
        case GLFW_KEY_7:
        case GLFW_KEY_KP_7:
            return Key::seven;
        default:
            break;
    }
    // GLFW's letter codes are positions on a US keyboard; people press what is printed on the key.
    const char* name = glfwGetKeyName(key, scancode);
    if (name != nullptr && name[0] != '\0' && name[1] == '\0') return letter_key(name[0]);
    if (key >= GLFW_KEY_A && key <= GLFW_KEY_Z) {
        return letter_key(static_cast<char>('a' + (key - GLFW_KEY_A)));
    }
    return std::nullopt;
}

GLFWwindow* open_window(const std::string& title, ImageSize size) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    GLFWwindow* handle = glfwCreateWindow(size.cols, size.rows, title.c_str(), nullptr, nullptr);
    if (handle == nullptr) throw NoWindow(glfw_complaint());
    return handle;
}

Window& window_of(GLFWwindow* handle) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(handle));
}

}  // namespace

GlfwLibrary::GlfwLibrary() {
    if (glfwInit() != GLFW_TRUE) throw NoWindow(glfw_complaint());
}

GlfwLibrary::~GlfwLibrary() {
    glfwTerminate();
}

Window::Window(const std::string& title, ImageSize size, InputState& input)
    : handle_(open_window(title, size)), input_(input), title_(title) {
    glfwMakeContextCurrent(handle_);
    try {
        load_gl(glfwGetProcAddress);
    } catch (const Error& error) {
        glfwDestroyWindow(handle_);
        throw NoWindow(error.what());
    }
    glfwSwapInterval(1);
    glfwGetCursorPos(handle_, &cursor_.x, &cursor_.y);
    install_callbacks();
}

Window::~Window() {
    glfwDestroyWindow(handle_);
}

void Window::install_callbacks() {
    glfwSetWindowUserPointer(handle_, this);
    glfwSetCursorPosCallback(handle_, [](GLFWwindow* handle, double x, double y) {
        Window& window = window_of(handle);
        window.touched_ = true;
        window.cursor_ = {x, y};
        window.input_.move(window.cursor_at());
    });
    glfwSetCursorEnterCallback(handle_, [](GLFWwindow* handle, int entered) {
        Window& window = window_of(handle);
        window.touched_ = true;
        if (entered == GLFW_FALSE) window.input_.leave();
    });
    glfwSetMouseButtonCallback(handle_, [](GLFWwindow* handle, int button, int action, int mods) {
        window_of(handle).on_button(button, action, mods);
    });
    glfwSetScrollCallback(handle_, [](GLFWwindow* handle, double, double steps) {
        Window& window = window_of(handle);
        window.touched_ = true;
        window.input_.wheel(steps, window.cursor_at());
    });
    glfwSetKeyCallback(handle_,
                       [](GLFWwindow* handle, int key, int scancode, int action, int mods) {
                           window_of(handle).on_key(key, scancode, action, mods);
                       });
    // ImGui needs every character; the callback only has to keep the window awake.
    glfwSetCharCallback(handle_,
                        [](GLFWwindow* handle, unsigned) { window_of(handle).touched_ = true; });
    glfwSetWindowFocusCallback(handle_, [](GLFWwindow* handle, int focused) {
        Window& window = window_of(handle);
        window.touched_ = true;
        if (focused == GLFW_FALSE) window.input_.lose_focus();
    });
    glfwSetDropCallback(handle_, [](GLFWwindow* handle, int count, const char** names) {
        Window& window = window_of(handle);
        window.touched_ = true;
        const std::vector<std::filesystem::path> files(names, names + count);
        window.input_.drop(files);
    });
    glfwSetWindowRefreshCallback(handle_,
                                 [](GLFWwindow* handle) { window_of(handle).touched_ = true; });
    glfwSetFramebufferSizeCallback(
        handle_, [](GLFWwindow* handle, int, int) { window_of(handle).touched_ = true; });
    glfwSetWindowCloseCallback(handle_,
                               [](GLFWwindow* handle) { window_of(handle).touched_ = true; });
}

void Window::on_key(int key, int scancode, int action, int mods) {
    touched_ = true;
    if (action != GLFW_PRESS) return;
    if (const std::optional<Key> ours = key_of(key, scancode))
        input_.key(*ours, modifiers_of(mods));
}

// GLFW 3.3 on X11 takes a motion to exactly (0, 0) for an echo of its own and does not report it.
void Window::notice_corner() {
    Cursor now;
    glfwGetCursorPos(handle_, &now.x, &now.y);
    if (now == Cursor{0.0, 0.0}) cursor_ = now;
}

void Window::on_button(int button, int action, int mods) {
    touched_ = true;
    const std::optional<MouseButton> ours = mouse_button(button);
    if (!ours) return;
    notice_corner();
    if (action == GLFW_PRESS) {
        input_.press(*ours, cursor_at(), modifiers_of(mods));
    } else {
        input_.release(*ours, cursor_at(), modifiers_of(mods));
    }
}

bool Window::wait(double seconds) {
    if (seconds > 0.0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
    return std::exchange(touched_, false);
}

void Window::wake() {
    glfwPostEmptyEvent();
}

void Window::swap() {
    glfwSwapBuffers(handle_);
}

void Window::hide() {
    glfwHideWindow(handle_);
}

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(handle_, title_.c_str());
}

void Window::set_clipboard(const std::string& text) {
    glfwSetClipboardString(handle_, text.c_str());
}

bool Window::close_wanted() const {
    return glfwWindowShouldClose(handle_) != GLFW_FALSE;
}

WindowMetrics Window::metrics() const {
    int width = 0;
    int height = 0;
    WindowMetrics metrics;
    glfwGetWindowSize(handle_, &width, &height);
    glfwGetFramebufferSize(handle_, &metrics.framebuffer_cols, &metrics.framebuffer_rows);
    metrics.window_width = width;
    metrics.window_height = height;
    return metrics;
}

double Window::content_scale() const {
    float x = 1.0f;
    float y = 1.0f;
    glfwGetWindowContentScale(handle_, &x, &y);
    const WindowMetrics size = metrics();
    const double density =
        size.window_height > 0.0 ? size.framebuffer_rows / size.window_height : 1.0;
    const double scale = density > 0.0 ? static_cast<double>(y) / density : 1.0;
    return std::isfinite(scale) && scale > 0.0 ? scale : 1.0;
}

}  // namespace raypick
