// EGL without a surface: draws on the GPU or in software, needs no display.
#pragma once

namespace raypick {

// A current OpenGL 3.3 core context of libEGL.
class EglContext {
public:
    // Throws NoOpenGL.
    EglContext();
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

private:
    void open();
    void close();

    void* display_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace raypick
