// First pass: how far the closest surface is.
#include "shape.glsl"

void main() {
    vec3 direction = eye_direction();
    float t_min = near_t(direction);
    Surface s = closest_surface(direction, t_min);
    if (!(s.t > t_min)) discard;
    gl_FragDepth = s.t * kDepthFromT;
}
