// One cone of a set, exactly.
uniform bool cone_capped;

#ifdef TEXTURED
// As axis_frame of tracer/geometry/axis_frame.h.
vec3 frame_x(vec3 y) {
    vec3 a = abs(y);
    vec3 least = vec3(0.0, 0.0, 1.0);
    if (a.x <= a.y && a.x <= a.z) {
        least = vec3(1.0, 0.0, 0.0);
    } else if (a.y <= a.z) {
        least = vec3(0.0, 1.0, 0.0);
    }
    return normalize(least - dot(least, y) * y);
}
#endif

Surface closest_surface(Ray ray) {
    vec4 base = texelFetch(elements, 2 * element);
    vec4 apex = texelFetch(elements, 2 * element + 1);
    vec3 axis = apex.xyz - base.xyz;
    float scale = max(largest(axis), max(base.w, apex.w));
    axis /= scale;
    ConeBody cone;
    cone.length = length(axis);
    cone.axis = axis / cone.length;
    cone.base_radius = base.w / scale;
    cone.apex_radius = apex.w / scale;
    cone.capped = cone_capped;
#ifdef TEXTURED
    cone.x = frame_x(cone.axis);
#endif
    vec3 origin = (object_vector(ray.origin) - from_eye(2 * element).xyz) / scale;
    return closest_on_cone(ray, origin, object_vector(ray.direction) / scale, cone, scale,
                           first_primitive + element, element_material());
}
