// Mesa's off-screen interface: draws into memory, needs no display and no GPU.
#pragma once

namespace raypick {

// A current OpenGL 3.3 core context of libOSMesa.
class OsmesaContext {
public:
    // Throws NoOpenGL.
    OsmesaContext();
    ~OsmesaContext();
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;

private:
    using Destroy = void (*)(void*);

    void* context_ = nullptr;
    Destroy destroy_ = nullptr;
    // OSMesa wants a buffer to draw to; all our drawing goes to framebuffer objects.
    unsigned char pixel_[4] = {};
};

}  // namespace raypick
