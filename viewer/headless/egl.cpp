#include "viewer/headless/egl.h"

#include "viewer/gl/load_gl.h"
#include "viewer/headless/offscreen_context.h"
#include "viewer/headless/shared_library.h"

#include <cstdint>

namespace raypick {

namespace {

// From EGL/egl.h and EGL/eglext.h (EGL 1.5), so that building needs no header of a library opened
// at run time.
constexpr std::int32_t kSurfaceType = 0x3033;
constexpr std::int32_t kPbufferBit = 0x0001;
constexpr std::int32_t kRenderableType = 0x3040;
constexpr std::int32_t kOpenglBit = 0x0008;
constexpr std::int32_t kNone = 0x3038;
constexpr unsigned kOpenglApi = 0x30A2;
constexpr std::int32_t kContextMajorVersion = 0x3098;
constexpr std::int32_t kContextMinorVersion = 0x30FB;
constexpr std::int32_t kContextProfileMask = 0x30FD;
constexpr std::int32_t kCoreProfileBit = 0x0001;
constexpr unsigned kPlatformSurfacelessMesa = 0x31DD;
constexpr unsigned kPlatformDeviceExt = 0x313F;

using Display = void*;
using Device = void*;
using GetPlatformDisplay = Display (*)(unsigned, void*, const std::int32_t*);

// The functions we call.
struct Egl {
    SharedLibrary library{"libEGL.so.1", "libEGL.so"};
    GLADloadfunc get_proc_address = library.function<GLADloadfunc>("eglGetProcAddress");

    template <typename Function>
    Function core(const char* name) const {
        return library.function<Function>(name);
    }
    // Extensions: null if missing.
    template <typename Function>
    Function extension(const char* name) const {
        return reinterpret_cast<Function>(get_proc_address(name));
    }
};

bool initialised(const Egl& egl, Display display) {
    const auto initialize =
        egl.core<unsigned (*)(Display, std::int32_t*, std::int32_t*)>("eglInitialize");
    return display != nullptr && initialize(display, nullptr, nullptr) != 0;
}

// Mesa's surfaceless platform, else the first device that works (NVIDIA's driver).
Display open_display(const Egl& egl) {
    const auto get = egl.extension<GetPlatformDisplay>("eglGetPlatformDisplayEXT");
    if (get == nullptr) throw NoOpenGL("it knows no platforms without a display");
    const auto query_devices =
        egl.extension<unsigned (*)(std::int32_t, Device*, std::int32_t*)>("eglQueryDevicesEXT");
    Device devices[16] = {};
    std::int32_t count = 0;
    if (query_devices == nullptr || query_devices(16, devices, &count) == 0) count = 0;
    Display display = get(kPlatformSurfacelessMesa, nullptr, nullptr);
    if (initialised(egl, display)) return display;
    for (std::int32_t i = 0; i < count; ++i) {
        display = get(kPlatformDeviceExt, devices[i], nullptr);
        if (initialised(egl, display)) return display;
    }
    throw NoOpenGL("neither the surfaceless platform nor a device works");
}

}  // namespace

EglContext::EglContext() {
    try {
        open();
    } catch (...) {
        close();
        throw;
    }
}

EglContext::~EglContext() {
    close();
}

void EglContext::open() {
    const Egl egl;
    display_ = open_display(egl);
    const auto bind_api = egl.core<unsigned (*)(unsigned)>("eglBindAPI");
    const auto choose_config =
        egl.core<unsigned (*)(Display, const std::int32_t*, void**, std::int32_t, std::int32_t*)>(
            "eglChooseConfig");
    const auto create_context =
        egl.core<void* (*)(Display, void*, void*, const std::int32_t*)>("eglCreateContext");
    const auto make_current =
        egl.core<unsigned (*)(Display, void*, void*, void*)>("eglMakeCurrent");
    const std::int32_t wanted[] = {kSurfaceType, kPbufferBit, kRenderableType, kOpenglBit, kNone};
    void* config = nullptr;
    std::int32_t configs = 0;
    if (bind_api(kOpenglApi) == 0 || choose_config(display_, wanted, &config, 1, &configs) == 0 ||
        configs == 0) {
        throw NoOpenGL("its display offers no desktop OpenGL");
    }
    const std::int32_t attributes[] = {
        kContextMajorVersion, 3,    kContextMinorVersion, 3, kContextProfileMask,
        kCoreProfileBit,      kNone};
    context_ = create_context(display_, config, nullptr, attributes);
    if (context_ == nullptr) throw NoOpenGL("it gives no OpenGL 3.3 core context");
    if (make_current(display_, nullptr, nullptr, context_) == 0) {
        throw NoOpenGL("its context cannot be made current without a surface");
    }
    load_gl(egl.get_proc_address);
}

void EglContext::close() {
    if (display_ == nullptr) return;
    const Egl egl;
    egl.core<unsigned (*)(Display, void*, void*, void*)>("eglMakeCurrent")(display_, nullptr,
                                                                           nullptr, nullptr);
    if (context_ != nullptr) {
        egl.core<unsigned (*)(Display, void*)>("eglDestroyContext")(display_, context_);
    }
    // The display stays open: it is the process's, and whoever else uses it doesn't count.
    display_ = nullptr;
}

}  // namespace raypick
