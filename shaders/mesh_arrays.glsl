// A mesh as it lies on the GPU.
uniform usamplerBuffer triangles;  // a texel: three vertices and the material
uniform samplerBuffer positions;   // object space
uniform vec3 eye_high;             // the eye in object space is eye_high + eye_low
uniform vec3 eye_low;

// A vertex relative to the eye, object space.
vec3 from_eye(uint vertex) {
    return (texelFetch(positions, int(vertex)).xyz - eye_high) - eye_low;
}
