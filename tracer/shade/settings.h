// What a person can set about a ray-traced frame.
#pragma once

namespace raypick {

struct RenderSettings {
    int depth = 5;  // longest chain of rays; the eye ray is depth 1
    bool shadows = true;
    bool reflections = true;
    bool refractions = true;
    int threads = 0;  // 0: all cores. Never changes the image

    friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

}  // namespace raypick
