// The shape that this program draws. Each shape's file has
//     Surface closest_surface(Ray ray)
// which gives the closest hit beyond ray.t_min that is_there() accepts, else no_surface().
#include "ray.glsl"
#include "surface.glsl"
#ifdef TEXTURED
// A file is included once: what the next ones share, not within the branch of one.
#include "materials.glsl"
#include "maps.glsl"
#endif
#ifdef CUT_OUT
#include "cut_out.glsl"
#endif

// Whether rays see this hit at all; gives it its final material.
bool is_there(inout Surface s) {
    if (sides != 0 && (sides == 1) != s.front) return false;
    if (object_material != kNoMaterial) s.material = object_material;
#ifdef CUT_OUT
    if (cut_out(s)) return false;
#endif
    return true;
}

// What several shapes share: a file is included once, so not within the branch of one shape.
#include "around_axis.glsl"
#include "slab.glsl"
#include "cone_body.glsl"
#include "unit_space.glsl"
#include "unit_sphere.glsl"
#if defined(SHAPE_SPHERE_SET) || defined(SHAPE_CONE_SET)
#include "set_element.glsl"
#endif

#if defined(SHAPE_MESH)
#include "mesh.glsl"
#elif defined(SHAPE_SPHERE)
#include "sphere.glsl"
#elif defined(SHAPE_BOX)
#include "box.glsl"
#elif defined(SHAPE_PLANE)
#include "plane.glsl"
#elif defined(SHAPE_DISK)
#include "disk.glsl"
#elif defined(SHAPE_RECTANGLE)
#include "rectangle.glsl"
#elif defined(SHAPE_CONE)
#include "cone.glsl"
#elif defined(SHAPE_TORUS)
#include "torus.glsl"
#elif defined(SHAPE_SPHERE_SET)
#include "sphere_set.glsl"
#elif defined(SHAPE_CONE_SET)
#include "cone_set.glsl"
#endif

// Depth is t itself, to full float precision: a power of two brings it below 1.
const float kDepthFromT = 1.0 / 18446744073709551616.0;  // 2^-64
const float kTieGap = 2e-6;                              // tracer/accel/hit.h
