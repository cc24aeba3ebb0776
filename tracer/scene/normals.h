// Shading normals for meshes that come without.
#pragma once

#include "tracer/geometry/shapes.h"

namespace raypick {

// Welds equal positions, then gives each vertex the area- and angle-weighted mean normal of the
// faces around it that meet at less than `crease_degrees`; vertices on creases are split. Triangle
// numbers and corner positions stay the same. 0 degrees: no normals at all, which means flat.
// Degenerate triangles take no part. `threads` (0: all cores) share the work; the result is the
// same for any number.
MeshData with_crease_normals(MeshData data, double crease_degrees, int threads = 0);

}  // namespace raypick
