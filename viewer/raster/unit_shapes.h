// Shapes in a space of their own, in which their shaders meet rays: the place, direction and size
// that a shape has in its object go into the transform, in double precision.
#pragma once

#include "tracer/geometry/shapes.h"
#include "tracer/geometry/transform.h"

namespace raypick {

// Of radius 1 around 0; the outside is +y. Angles are measured from x over z.
struct UnitDisk {
    float inner_radius = 0.0f;
};

// [0, 1] along x and y at z = 0; the outside is +z.
struct UnitSquare {};

// From a base at 0 along +y; the largest of its lengths is 1. Angles are measured from x over z.
struct UnitCone {
    float length = 1.0f;
    float base_radius = 1.0f;
    float apex_radius = 1.0f;
    bool capped = true;
};

// Of major radius 1 around 0, about +y.
struct UnitTorus {
    float minor_radius = 0.25f;
};

UnitDisk unit_shape(const Disk& disk);
UnitSquare unit_shape(const Rectangle& rectangle);
UnitCone unit_shape(const Cone& cone);
UnitTorus unit_shape(const Torus& torus);

// The shape of the object is this map's image of its unit shape.
Transform object_from_unit(const Disk& disk);
Transform object_from_unit(const Rectangle& rectangle);
Transform object_from_unit(const Cone& cone);
Transform object_from_unit(const Torus& torus);

}  // namespace raypick
