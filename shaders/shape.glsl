// The shape that this program draws.
#include "ray.glsl"
#include "surface.glsl"
#if defined(SHAPE_MESH)
#include "mesh.glsl"
#elif defined(SHAPE_SPHERE)
#include "sphere.glsl"
#elif defined(SHAPE_BOX)
#include "box.glsl"
#elif defined(SHAPE_PLANE)
#include "plane.glsl"
#endif

// Depth is t itself, to full float precision: a power of two brings it below 1.
const float kDepthFromT = 1.0 / 18446744073709551616.0;  // 2^-64
const float kTieGap = 2e-6;                              // tracer/accel/hit.h
