// The camera: one ray for each pixel, the same as RayGenerator's (tracer/geometry/camera.h). Scene
// coordinates are relative to the eye everywhere in these shaders, so that nothing is lost to
// rounding far from the scene's origin.
layout(std140) uniform View {
    vec4 right;  // xyz: one pixel to the right on the image at distance 1
    vec4 up;     // xyz: one pixel up on it
    vec4 back;   // xyz: the camera's vz, against the view; w: distance of the near plane
    vec4 size;   // xy: columns and rows
};

// Clip coordinates from (clip x, clip y, distance along the view): far is infinite.
vec4 clip_position(vec3 p) {
    return vec4(p.xy, p.z - 2.0 * back.w, p.z);
}
