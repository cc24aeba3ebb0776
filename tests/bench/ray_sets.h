// Rays to trace, the same floats for every peer.
#pragma once

#include "tests/bench/scenes.h"
#include "tracer/accel/accel.h"

#include <cstddef>
#include <vector>

namespace raypick::bench {

struct RaySets {
    std::vector<Ray> primary;  // 64 in a row are of 8 x 8 pixels: see pixels_in_squares()
    std::vector<Ray> shadow;   // from what the primary rays hit to the view's light, in that order
    std::vector<Ray> mirror;   // from what they hit, in that order
    std::vector<Ray> random;   // from anywhere in the scene's box to anywhere, without order
};

RaySets make_ray_sets(const Accel& accel, const View& view, ImageSize size);

}  // namespace raypick::bench
