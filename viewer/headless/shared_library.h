// A shared library opened at run time.
#pragma once

#include <initializer_list>
#include <string>

namespace raypick {

// Stays open until the process ends: OpenGL drivers start threads that outlive their contexts.
class SharedLibrary {
public:
    // Opens the first of `names` that is there. Throws NoOpenGL that says why none is.
    SharedLibrary(std::initializer_list<const char*> names);

    // The function `name`; throws NoOpenGL if the library lacks it.
    template <typename Function>
    [[nodiscard]] Function function(const char* name) const {
        return reinterpret_cast<Function>(symbol(name));
    }

private:
    [[nodiscard]] void* symbol(const char* name) const;

    std::string name_;
    void* handle_ = nullptr;
};

}  // namespace raypick
