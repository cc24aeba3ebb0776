// Rays to trace, the same floats for every peer.
#pragma once

#include "tests/bench/scenes.h"
#include "tracer/accel/accel.h"

#include <cstddef>
#include <vector>

namespace raypick::bench {

struct RaySets {
    std::vector<Ray> primary;  // in blocks of 16 x 4 pixels, so that 64 in a row are one block
    std::vector<Ray> shadow;   // from what the primary rays hit to the view's light, in that order
    std::vector<Ray> mirror;   // from what they hit, in that order
    std::vector<Ray> random;   // from anywhere in the scene's box to anywhere, without order
};

RaySets make_ray_sets(const Accel& accel, const View& view, ImageSize size);

}  // namespace raypick::bench
