// The rectangle around a sphere of a set.
#include "billboard.glsl"
#include "set_arrays.glsl"

flat out int element;

void main() {
    element = gl_VertexID / 6;
    vec4 sphere = from_eye(element);
    Round ball = Round(sphere.xyz, sphere.w, vec3(0.0));
    gl_Position = billboard_position(ball, ball);
}
