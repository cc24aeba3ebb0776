// The unit sphere at 0, in an object space that is `radius` times as large.

#ifdef TEXTURED
// Longitude from +x over +z and colatitude from +y, as sphere_uv of tracer/geometry/shapes.cpp.
void set_sphere_frame(inout Surface s, vec3 n, float radius) {
    float longitude = atan(n.z, n.x) / kTurn;
    float rim = length(n.xz);
    vec2 uv = vec2(longitude < 0.0 ? longitude + 1.0 : longitude, atan(rim, n.y) / (0.5 * kTurn));
    if (rim == 0.0) {
        set_texture_frame(s, uv, vec3(0.0), vec3(0.0));  // a pole has no longitude
        return;
    }
    vec3 dpdv = vec3(n.y * n.x / rim, -rim, n.y * n.z / rim);
    set_texture_frame(s, uv, kTurn * radius * vec3(-n.z, 0.0, n.x), 0.5 * kTurn * radius * dpdv);
}
#endif

// `origin` is the ray's, `power` is dot(origin, origin) - 1 as precisely as it is known; the ray's
// direction is that of the space.
Surface closest_on_sphere(Ray ray, vec3 origin, float power, float radius, uint primitive,
                          uint material) {
    vec3 d = object_vector(ray.direction) / radius;
    float speed = length(d);
    d /= speed;
    float b = -dot(origin, d);
    vec3 closest = origin + b * d;
    float discriminant = 1.0 - dot(closest, closest);
    if (!(discriminant >= 0.0)) return no_surface();
    float root = sqrt(discriminant);
    float q = b < 0.0 ? b - root : b + root;
    float other = q != 0.0 ? power / q : 0.0;
    for (int i = 0; i < 2; ++i) {
        float t = i == 0 ? min(q, other) : max(q, other);
        Surface s = no_surface();
        s.t = t / speed;
        if (!(s.t > ray.t_min)) continue;
        vec3 n = origin + t * d;
        s.geometric = scene_normal(n);
        s.shading = s.geometric;
        s.front = i == 0;
        s.primitive = primitive;
        s.material = material;
#ifdef TEXTURED
        set_sphere_frame(s, n / length(n), radius);
#endif
        if (is_there(s)) return s;
    }
    return no_surface();
}
