// One sphere of a set, exactly.
Surface closest_surface(Ray ray) {
    vec4 sphere = from_eye(element);
    vec3 origin = (object_vector(ray.origin) - sphere.xyz) / sphere.w;
    float distance = length(origin);
    return closest_on_sphere(ray, origin, (distance - 1.0) * (distance + 1.0), sphere.w,
                             uint(first_primitive + element), element_material());
}
