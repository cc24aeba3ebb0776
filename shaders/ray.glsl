// The ray of this fragment.
#include "view.glsl"

// Unit direction of the ray through this fragment's pixel centre. gl_FragCoord counts rows from
// the bottom, and so does this formula: no row is turned over here.
vec3 eye_direction() {
    vec2 p = gl_FragCoord.xy - 0.5 * size.xy;
    return normalize(p.x * right.xyz + p.y * up.xyz - back.xyz);
}

// Where a ray passes the near plane: near / cos.
float near_t(vec3 direction) {
    return back.w / -dot(direction, back.xyz);
}
