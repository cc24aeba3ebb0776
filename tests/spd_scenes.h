// Scenes of the Standard Procedural Databases as NFF text, made by their published description:
// Eric Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and the
// package's own, version 3.13.
#pragma once

#include <string>

namespace raypick {

// 4 x 4 x 4 gears on a mirroring floor, each of two faces with 144 corners and 144 sides. Every
// fifth is of glass. Five lights.
std::string spd_gears();

// A tree by the method of Aono and Kunii, twelve generations of a cone and a sphere each, on a
// field. Seven lights.
std::string spd_tree();

// Mirroring spheres on a grid of 13 x 13 x 13 with matt cylinders between neighbours, by Antonio
// Costa. Six lights.
std::string spd_lattice();

// Newell's teapot of 32 Bezier patches, each cut into 12 x 12 x 2 smooth triangles, on a mirroring
// checkerboard of 12 x 12 squares. Two lights.
std::string spd_teapot();

}  // namespace raypick
