// An OpenGL 3.3 core context without a window or display: OSMesa, or EGL surfaceless.
#pragma once

#include "tracer/error.h"

#include <memory>
#include <string>

namespace raypick {

// No back-end could be opened. The program exits with 77 (CTest's skip code).
class NoOpenGL : public Error {
public:
    using Error::Error;
};

enum class OffscreenBackend { any, osmesa, egl };

// Opens the library at run time (neither is linked), makes the context current on the calling
// thread and loads the GL functions. One back-end a process: libOSMesa and libGL share state.
class OffscreenContext {
public:
    // `any` tries OSMesa, then EGL. Throws NoOpenGL with one line that says what was tried.
    explicit OffscreenContext(OffscreenBackend backend = OffscreenBackend::any);
    ~OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;

    // GL_RENDERER and GL_VERSION, for messages.
    [[nodiscard]] std::string description() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace raypick
