// The ray of this fragment.
#include "view.glsl"

// Scene space, relative to the eye. Only what lies beyond t_min counts.
struct Ray {
    vec3 origin;
    vec3 direction;  // unit
    float t_min;
};

// From the eye to this fragment's pixel centre on the image. gl_FragCoord counts rows from the
// bottom, and so does this formula: no row is turned over here.
vec3 image_offset() {
    vec2 p = gl_FragCoord.xy - 0.5 * size.xy;
    return p.x * right.xyz + p.y * up.xyz;
}

Ray eye_ray() {
    vec3 offset = image_offset();
    if (is_orthographic()) return Ray(offset, -back.xyz, back.w);
    vec3 direction = normalize(offset - back.xyz);
    return Ray(vec3(0.0), direction, back.w / -dot(direction, back.xyz));  // near / cos
}
