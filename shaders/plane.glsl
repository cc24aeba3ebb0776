// An infinite plane, exactly.
uniform vec3 plane_normal;   // scene space, unit
uniform float plane_height;  // of the eye above it, from double precision

Surface closest_surface(vec3 direction, float t_min) {
    Surface s;
    s.t = -plane_height / dot(plane_normal, direction);
    s.geometric = plane_normal;
    s.shading = plane_normal;
    s.primitive = 0u;
    s.material = kNoMaterial;
    return s;
}
