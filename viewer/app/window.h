// A window with an OpenGL 3.3 core context; its events go into an InputState.
#pragma once

#include "picking/cursor.h"
#include "tracer/error.h"
#include "tracer/geometry/pixel.h"
#include "viewer/app/input_state.h"

#include <string>

struct GLFWwindow;

namespace raypick {

// No window could be opened; says why.
class NoWindow : public Error {
public:
    using Error::Error;
};

// GLFW from its start to its end. One at a time a process, main thread only.
class GlfwLibrary {
public:
    GlfwLibrary();  // throws NoWindow
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

class Window {
public:
    // Opens the window, makes its context current and loads the OpenGL functions. Throws NoWindow.
    // `input` must outlive the window.
    Window(const std::string& title, ImageSize size, InputState& input);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Sleeps until an event arrives, wake() is called or the time is over; handles all events.
    // True if there was an event that may change what is shown.
    bool wait(double seconds);
    // Ends a wait from any thread.
    static void wake();

    void swap();
    void hide();
    void set_title(const std::string& title);
    void set_clipboard(const std::string& text);
    [[nodiscard]] bool close_wanted() const;
    [[nodiscard]] WindowMetrics metrics() const;
    // The monitor's content scale in window units: what fonts and panels should be scaled by.
    [[nodiscard]] double content_scale() const;
    [[nodiscard]] GLFWwindow* handle() const { return handle_; }

private:
    void install_callbacks();
    [[nodiscard]] CursorAt cursor_at() const { return {cursor_, metrics()}; }
    void notice_corner();
    void on_key(int key, int scancode, int action, int mods);
    void on_button(int button, int action, int mods);

    GlfwLibrary library_;
    GLFWwindow* handle_ = nullptr;
    InputState& input_;
    // From the last motion event. Asking GLFW would give where the cursor is by now, not where it
    // was at the event.
    Cursor cursor_;
    bool touched_ = true;
    std::string title_;
};

}  // namespace raypick
