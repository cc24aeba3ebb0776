// The rectangle around a cone of a set.
#include "billboard.glsl"
#include "set_arrays.glsl"

flat out int element;

void main() {
    element = gl_VertexID / 6;
    vec4 base = from_eye(2 * element);
    vec4 apex = from_eye(2 * element + 1);
    vec3 axis = texelFetch(elements, 2 * element + 1).xyz - texelFetch(elements, 2 * element).xyz;
    axis = normalize(axis / max(abs(axis.x), max(abs(axis.y), abs(axis.z))));
    gl_Position =
        billboard_position(Round(base.xyz, base.w, axis), Round(apex.xyz, apex.w, axis));
}
