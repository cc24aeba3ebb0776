// A set of spheres or cones as it lies on the GPU. Elements are counted within this draw.
uniform samplerBuffer elements;  // object space: a centre and the radius there
uniform vec3 eye_high;           // the eye in object space is eye_high + eye_low
uniform vec3 eye_low;

// A centre relative to the eye, with its radius.
vec4 from_eye(int texel) {
    vec4 ball = texelFetch(elements, texel);
    return vec4((ball.xyz - eye_high) - eye_low, ball.w);
}
