#include "viewer/headless/shared_library.h"

#include "viewer/headless/offscreen_context.h"

#include <dlfcn.h>

namespace raypick {

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names) {
    std::string reason;
    for (const char* name : names) {
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (handle_ != nullptr) {
            name_ = name;
            return;
        }
        if (reason.empty()) reason = dlerror();
    }
    throw NoOpenGL(reason);
}

void* SharedLibrary::symbol(const char* name) const {
    void* address = dlsym(handle_, name);
    if (address == nullptr) throw NoOpenGL(name_ + " has no function " + name);
    return address;
}

}  // namespace raypick
