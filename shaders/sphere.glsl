// A sphere, exactly. Object space is scaled so that its radius is 1 and moved so that its centre
// is 0.
//
// Source: Haines, Guenther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection",
// Ray Tracing Gems, 2019.
uniform vec3 sphere_eye;         // the eye
uniform float sphere_eye_power;  // dot(eye, eye) - 1, from double precision

Surface closest_surface(vec3 direction, float t_min) {
    Surface s;
    s.t = kMiss;
    s.primitive = 0u;
    s.material = kNoMaterial;
    vec3 d = object_direction(direction);
    float speed = length(d);
    d /= speed;
    float b = -dot(sphere_eye, d);
    vec3 closest = sphere_eye + b * d;
    float discriminant = 1.0 - dot(closest, closest);
    if (!(discriminant >= 0.0)) return s;
    float root = sqrt(discriminant);
    float q = b < 0.0 ? b - root : b + root;
    float other = q != 0.0 ? sphere_eye_power / q : 0.0;
    float near = min(q, other) / speed;
    s.t = near > t_min ? near : max(q, other) / speed;
    s.geometric = scene_normal(sphere_eye + (s.t * speed) * d);
    s.shading = s.geometric;
    return s;
}
