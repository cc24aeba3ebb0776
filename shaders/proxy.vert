// The twelve triangles of a box around a shape, counter-clockwise seen from outside.
#include "view.glsl"

uniform mat3 clip_from_scene;
uniform vec3 proxy_min;  // relative to the eye
uniform vec3 proxy_max;

// Corner bits: 1 is +x, 2 is +y, 4 is +z.
const int kCorners[36] = int[36](0, 4, 6, 0, 6, 2,   // -x
                                 1, 3, 7, 1, 7, 5,   // +x
                                 0, 1, 5, 0, 5, 4,   // -y
                                 2, 6, 7, 2, 7, 3,   // +y
                                 0, 2, 3, 0, 3, 1,   // -z
                                 4, 5, 7, 4, 7, 6);  // +z

void main() {
    int corner = kCorners[gl_VertexID];
    vec3 p = mix(proxy_min, proxy_max,
                 vec3(float(corner & 1), float((corner >> 1) & 1), float((corner >> 2) & 1)));
    gl_Position = clip_position(clip_from_scene * p);
}
