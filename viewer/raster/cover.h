// What is known to hide what lies behind it: for each pixel the nearest surface that surely takes
// it. Built from triangles by several threads at once, then asked.
#pragma once

#include "viewer/raster/spots.h"

#include <array>
#include <vector>

namespace raypick {

// A triangle on the image. All its corners are known.
using SpotTriangle = std::array<Spot, 3>;

class Cover {
public:
    // `pixel` is the larger side of a pixel's at distance 1.
    Cover(ImageSize size, float pixel);

    // False only if the triangle takes no pixel's centre. One that `hides` hides what is behind it
    // from now on. Any number of threads may add.
    bool add(const SpotTriangle& triangle, bool hides);
    // True only if nothing of the triangle can be seen. After all have been added. `stretch`: how
    // much longer its object makes vectors of one direction than those of another.
    [[nodiscard]] bool hidden(const SpotTriangle& triangle, float stretch) const;

private:
    [[nodiscard]] float shift(const SpotTriangle& triangle, float stretch) const;

    ImageSize size_;
    float pixel_;
    std::vector<float> nearness_;  // of each pixel; 0: nothing there
};

}  // namespace raypick
