#include "viewer/headless/offscreen_context.h"

#include "viewer/gl/load_gl.h"
#include "viewer/headless/egl.h"
#include "viewer/headless/osmesa.h"

#include <cstdlib>
#include <variant>

namespace raypick {

struct OffscreenContext::State {
    std::variant<std::monostate, OsmesaContext, EglContext> context;
    std::string description;
};

namespace {

// The person's own choice (RAYPICK_GL) goes before the program's `any`.
OffscreenBackend chosen(OffscreenBackend backend) {
    const char* name = std::getenv("RAYPICK_GL");
    if (backend != OffscreenBackend::any || name == nullptr || *name == '\0') return backend;
    if (std::string(name) == "osmesa") return OffscreenBackend::osmesa;
    if (std::string(name) == "egl") return OffscreenBackend::egl;
    throw NoOpenGL("RAYPICK_GL is \"" + std::string(name) + "\"; it can be osmesa or egl");
}

}  // namespace

OffscreenContext::OffscreenContext(OffscreenBackend backend) : state_(std::make_unique<State>()) {
    const OffscreenBackend wanted = chosen(backend);
    std::string tried;
    if (wanted != OffscreenBackend::egl) {
        try {
            state_->context.emplace<OsmesaContext>();
            state_->description = gl_description();
            return;
        } catch (const Error& error) {
            tried = std::string("OSMesa: ") + error.what();
        }
    }
    if (wanted != OffscreenBackend::osmesa) {
        try {
            state_->context.emplace<EglContext>();
            state_->description = gl_description();
            return;
        } catch (const Error& error) {
            if (!tried.empty()) tried += "; ";
            tried += std::string("EGL: ") + error.what();
        }
    }
    throw NoOpenGL("no OpenGL 3.3 without a window here (" + tried +
                   "); install libosmesa6 or libegl1");
}

OffscreenContext::~OffscreenContext() = default;

std::string OffscreenContext::description() const {
    return state_->description;
}

}  // namespace raypick
