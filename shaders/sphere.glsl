// A sphere, exactly. Object space is scaled so that its radius is 1 and moved so that its centre
// is 0.
//
// Source: Haines, Guenther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection",
// Ray Tracing Gems, 2019.
uniform vec3 sphere_eye;         // the eye
uniform float sphere_eye_power;  // dot(eye, eye) - 1, from double precision

Surface closest_surface(Ray ray) {
    vec3 offset = object_vector(ray.origin);
    float power = sphere_eye_power + dot(offset, 2.0 * sphere_eye + offset);
    return closest_on_sphere(ray, sphere_eye + offset, power, 1.0, 0u, kNoMaterial);
}
