// Where the corners of meshes lie on the image, as the rasteriser will have them, give or take.
#pragma once

#include "tracer/geometry/pixel.h"
#include "viewer/raster/view_numbers.h"

#include <span>

namespace raypick {

// How far, in pixels, OpenGL may have a corner from where a Spot has it, along either axis: the
// grid that it rounds to, if it has kSpotBits binary places or more, and what rounding to floats
// costs both.
inline constexpr int kSpotBits = 8;
inline constexpr float kSpotMargin = 0x1p-6f;

// A corner on the image. x grows with the column and y with GL's row, from 0 at the lower left
// corner of the image; pixel centres lie at halves.
struct Spot {
    float x = 0.0f;
    float y = 0.0f;
    // 1 / distance along the view, 1 in parallel views; or one of the two below.
    float nearness = 0.0f;
};
// So near to the plane of the eye, or so far out, that nothing is known.
inline constexpr float kUnknown = 0.0f;
// Nearer than the near plane: nothing of it is drawn.
inline constexpr float kClipped = -1.0f;

// Fills in as many spots as there are positions.
void find_spots(const ViewNumbers& view, const MeshNumbers& mesh,
                std::span<const glm::vec3> positions, std::span<Spot> spots);

}  // namespace raypick
