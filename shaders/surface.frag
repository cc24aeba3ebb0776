// Second pass, objects and primitives in ascending order: the first one that comes within the tie
// gap of the closest surface keeps the pixel (the stencil sees to "first").
#include "shape.glsl"
#ifdef NORMAL_MAP
#include "normal_map.glsl"
#endif

uniform uint object_id;

layout(location = 0) out vec4 normal_t;
layout(location = 1) out uint object;
layout(location = 2) out uint primitive;
layout(location = 3) out uint material;
#ifdef TEXTURED
layout(location = 4) out vec2 uv;
layout(location = 5) out vec4 footprint_axes;
#endif

void main() {
    Ray ray = eye_ray();
    Surface s = closest_surface(ray);
    if (!(s.t > ray.t_min)) discard;
    gl_FragDepth = s.t * (1.0 - kTieGap) * kDepthFromT;
    // Both sides of a surface are lit: the normal goes to the eye's side.
    vec3 normal = unit(s.shading);
#ifdef TEXTURED
    Footprint covered =
        footprint(unit(s.geometric), s.dpdu, s.dpdv, ray.direction, cone_width(s.t));
#ifdef NORMAL_MAP
    normal = mapped_normal(s, normal, covered);
#endif
    uv = s.uv;
    footprint_axes = vec4(covered.major, covered.minor);
#endif
    if (!s.front) normal = -normal;
    normal_t = vec4(normal, s.t);
    object = object_id;
    primitive = s.primitive;
    material = s.material;
}
