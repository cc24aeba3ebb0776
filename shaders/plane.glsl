// An infinite plane, exactly.
uniform vec3 plane_normal;   // scene space, unit
uniform float plane_height;  // of the eye above it, from double precision
#ifdef TEXTURED
// uv = plane_uv + plane_uv_from_scene * (a point of the plane relative to the eye).
uniform vec2 plane_uv;
uniform vec3 plane_u;
uniform vec3 plane_v;
uniform vec3 plane_dpdu;  // scene space
uniform vec3 plane_dpdv;
#endif

Surface closest_surface(Ray ray) {
    float slope = dot(plane_normal, ray.direction);
    Surface s = no_surface();
    s.t = -(plane_height + dot(plane_normal, ray.origin)) / slope;
    if (!(s.t > ray.t_min)) return no_surface();
    s.geometric = plane_normal;
    s.shading = plane_normal;
    s.front = slope < 0.0;
#ifdef TEXTURED
    vec3 p = ray.origin + s.t * ray.direction;
    s.uv = plane_uv + vec2(dot(plane_u, p), dot(plane_v, p));
    s.dpdu = plane_dpdu;
    s.dpdv = plane_dpdv;
#endif
    if (is_there(s)) return s;
    return no_surface();
}
