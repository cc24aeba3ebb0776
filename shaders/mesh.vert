// A mesh's corners, three a triangle, relative to the eye before anything is rotated or scaled.
// They are read by number rather than through an index buffer: gl_PrimitiveID would be the other
// way to tell the fragments their triangle, and software OpenGL takes a slow path for it.
#include "mesh_arrays.glsl"
#include "view.glsl"

uniform mat3 clip_from_object;

flat out int triangle_index;

void main() {
    triangle_index = gl_VertexID / 3;
    uvec4 triangle = texelFetch(triangles, triangle_index);
    int k = gl_VertexID - 3 * triangle_index;
    gl_Position =
        clip_position(clip_from_object *
                      from_eye(k == 0 ? triangle.x : k == 1 ? triangle.y : triangle.z));
}
