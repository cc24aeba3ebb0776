// The camera: one ray for each pixel, the same as RayGenerator's (tracer/geometry/camera.h). Scene
// coordinates are relative to the eye everywhere in these shaders, so that nothing is lost to
// rounding far from the scene's origin.
layout(std140) uniform View {
    vec4 right;  // xyz: one pixel to the right on the image at distance 1; w: 1 if the view is
                 // orthographic, which has that image everywhere
    vec4 up;     // xyz: one pixel up on it
    vec4 back;   // xyz: the camera's vz, against the view; w: distance of the near plane
    vec4 size;   // xy: columns and rows
};

bool is_orthographic() {
    return right.w != 0.0;
}

// A pixel's cone, as RayGenerator::cone(): how much wider it is per unit of t, and its width at t.
float cone_spread() {
    return is_orthographic() ? 0.0 : length(up.xyz);
}
float cone_width(float t) {
    return is_orthographic() ? length(up.xyz) : t * length(up.xyz);
}

// Clip coordinates from (clip x, clip y, distance along the view): far is infinite. Parallel views
// need no clipping in depth: their shaders drop what is nearer than the near plane.
vec4 clip_position(vec3 p) {
    return is_orthographic() ? vec4(p.xy, 0.0, 1.0) : vec4(p.xy, p.z - 2.0 * back.w, p.z);
}
