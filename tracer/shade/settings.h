// What a person can set about a ray-traced frame.
#pragma once

#include <cstdint>

namespace raypick {

// What lies between a light and a point: glass blocks it like anything else (the notes' rule), or
// lets `transmit` (and what absorption leaves) of it through, unbent.
enum class GlassShadows { opaque, tinted };

// Where a pixel is sampled.
enum class Sampling {
    centre,      // one ray through the pixel's centre
    corners,     // one ray through each corner of the pixels: (rows + 1) x (cols + 1) rays; a pixel
                 // is the mean of its four (the rule behind the published counts)
    stratified,  // samples x samples, one at random in each cell
    adaptive,    // the centre; stratified where the colour differs from a neighbour's
};

enum class PixelFilter { box, tent, gaussian, mitchell };

struct RenderSettings {
    // Longest chain of rays; the eye ray is depth 1. Each takes up to 1 MB of memory a thread,
    // where all rays split, and about 1 kB of its stack, so that some thousands are too many.
    int depth = 5;
    bool shadows = true;
    bool reflections = true;
    bool refractions = true;
    GlassShadows glass_shadows = GlassShadows::opaque;
    // Rays that can add no more than this to a pixel are left out. 0: every ray of a reflecting or
    // transmitting surface is shot, also those of weight 0 (the rule behind the published counts).
    float cutoff = 1.0f / 1024;

    Sampling sampling = Sampling::centre;
    int samples = 4;         // of stratified and adaptive: samples x samples, 1..64
    float contrast = 0.05f;  // of adaptive: difference in sRGB, 0..1, that is worth more samples
    PixelFilter filter = PixelFilter::box;
    std::uint64_t seed = 0;  // of everything random; the same seed, the same image

    double aperture = 0.0;        // diameter of the lens in scene units; 0: everything is sharp
    double focus_distance = 0.0;  // along the view axis; 0: at the camera's `at`

    int threads = 0;  // 0: all cores. Never changes the image

    friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

}  // namespace raypick
