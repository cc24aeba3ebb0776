// A box along the axes of object space, exactly.
uniform vec3 box_min;  // relative to the eye, from double precision
uniform vec3 box_max;

// The first axis on which `v` is `value`.
int axis_of(vec3 v, float value) {
    return v.x == value ? 0 : v.y == value ? 1 : 2;
}

#ifdef TEXTURED
// Face coordinates, as box_hit of tracer/geometry/shapes.cpp.
void set_box_frame(inout Surface s, vec3 p, int axis) {
    int i = (axis + 1) % 3;
    int j = (axis + 2) % 3;
    vec3 extent = box_max - box_min;
    vec3 along_i = vec3(0.0);
    vec3 along_j = vec3(0.0);
    along_i[i] = extent[i];
    along_j[j] = extent[j];
    // Along an axis on which the box is flat there is nothing to share.
    vec2 size = vec2(extent[i], extent[j]);
    vec2 at = clamp(vec2(p[i] - box_min[i], p[j] - box_min[j]) / max(size, 1e-37), 0.0, 1.0);
    set_texture_frame(s, mix(vec2(0.0), at, greaterThan(size, vec2(0.0))), along_i, along_j);
}
#endif

Surface closest_surface(Ray ray) {
    vec3 o = object_vector(ray.origin);
    vec3 d = object_vector(ray.direction);
    vec2 x = between(box_min.x - o.x, box_max.x - o.x, d.x);
    vec2 y = between(box_min.y - o.y, box_max.y - o.y, d.y);
    vec2 z = between(box_min.z - o.z, box_max.z - o.z, d.z);
    float enter = max(x.x, max(y.x, z.x));
    float leave = min(x.y, min(y.y, z.y));
    if (!(enter <= leave)) return no_surface();
    for (int i = 0; i < 2; ++i) {
        bool entering = i == 0;
        Surface s = no_surface();
        s.t = entering ? enter : leave;
        if (!(s.t > ray.t_min)) continue;
        int axis = entering ? axis_of(vec3(x.x, y.x, z.x), enter)
                            : axis_of(vec3(x.y, y.y, z.y), leave);
        // A ray that runs upwards enters through the lower face and leaves through the upper one.
        bool upper = (d[axis] > 0.0) != entering;
        s.primitive = uint(2 * axis + (upper ? 1 : 0));  // -x +x -y +y -z +z
        vec3 normal = vec3(0.0);
        normal[axis] = upper ? 1.0 : -1.0;
        s.geometric = scene_normal(normal);
        s.shading = s.geometric;
        s.front = entering;
#ifdef TEXTURED
        set_box_frame(s, o + s.t * d, axis);
#endif
        if (is_there(s)) return s;
    }
    return no_surface();
}
