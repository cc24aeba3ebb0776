#include "viewer/headless/osmesa.h"

#include "viewer/gl/load_gl.h"
#include "viewer/headless/offscreen_context.h"
#include "viewer/headless/shared_library.h"

// OSMesa 22.3 never frees a few bytes of each context; LeakSanitizer must not blame us for them.
#if defined(__SANITIZE_ADDRESS__)
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the sanitizer chose the name
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOSMesa.so\n";
}
#endif

namespace raypick {

namespace {

// From GL/osmesa.h of Mesa 22.3, so that building needs no header of a library opened at run time.
constexpr int kFormat = 0x22;
constexpr int kProfile = 0x33;
constexpr int kCoreProfile = 0x34;
constexpr int kOsmesaMajorVersion = 0x36;
constexpr int kOsmesaMinorVersion = 0x37;
constexpr int kRgba = 0x1908;

}  // namespace

OsmesaContext::OsmesaContext() {
    const SharedLibrary library({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"});
    const auto create =
        library.function<void* (*)(const int*, void*)>("OSMesaCreateContextAttribs");
    const auto make_current =
        library.function<unsigned char (*)(void*, void*, unsigned, int, int)>("OSMesaMakeCurrent");
    const auto get_proc_address = library.function<GLADloadfunc>("OSMesaGetProcAddress");
    destroy_ = library.function<Destroy>("OSMesaDestroyContext");
    const int attributes[] = {
        kFormat, kRgba, kProfile, kCoreProfile, kOsmesaMajorVersion, 3, kOsmesaMinorVersion, 3, 0};
    context_ = create(attributes, nullptr);
    if (context_ == nullptr) throw NoOpenGL("it gives no OpenGL 3.3 core context");
    if (make_current(context_, pixel_, GL_UNSIGNED_BYTE, 1, 1) == 0) {
        destroy_(context_);
        throw NoOpenGL("its context cannot be made current");
    }
    try {
        load_gl(get_proc_address);
    } catch (...) {
        destroy_(context_);
        throw;
    }
}

OsmesaContext::~OsmesaContext() {
    destroy_(context_);
}

}  // namespace raypick
