// First pass: how far the closest surface is.
#include "shape.glsl"

void main() {
    Ray ray = eye_ray();
    Surface s = closest_surface(ray);
    if (!(s.t > ray.t_min)) discard;
    gl_FragDepth = s.t * kDepthFromT;
}
