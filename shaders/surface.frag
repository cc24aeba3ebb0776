// Second pass, objects and primitives in ascending order: the first one that comes within the tie
// gap of the closest surface keeps the pixel (the stencil sees to "first").
#include "shape.glsl"

uniform uint object_id;

layout(location = 0) out vec4 normal_t;
layout(location = 1) out uint object;
layout(location = 2) out uint primitive;
layout(location = 3) out uint material;

void main() {
    vec3 direction = eye_direction();
    float t_min = near_t(direction);
    Surface s = closest_surface(direction, t_min);
    if (!(s.t > t_min)) discard;
    gl_FragDepth = s.t * (1.0 - kTieGap) * kDepthFromT;
    // Both sides of a surface are lit: the normal goes to the eye's side.
    vec3 normal = unit(s.shading);
    if (dot(s.geometric, direction) > 0.0) normal = -normal;
    normal_t = vec4(normal, s.t);
    object = object_id;
    primitive = s.primitive;
    material = object_material != kNoMaterial ? object_material : s.material;
}
