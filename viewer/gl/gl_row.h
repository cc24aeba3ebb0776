// Where our rows meet OpenGL's.
#pragma once

#include "tracer/geometry/pixel.h"

namespace raypick {

// Our row 0 is the top row, OpenGL's the bottom one. The only place that turns one into the other;
// it is its own inverse.
inline int gl_row(ImageSize size, int row) {
    return size.rows - 1 - row;
}

}  // namespace raypick
