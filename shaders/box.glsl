// A box along the axes of object space, exactly.
uniform vec3 box_min;  // relative to the eye, from double precision
uniform vec3 box_max;

// The part of the ray between two parallel faces. A ray along them is between them all the way or
// never.
vec2 between(float low, float high, float d) {
    if (d == 0.0) return low <= 0.0 && high >= 0.0 ? vec2(-3e38, 3e38) : vec2(3e38, -3e38);
    float a = low / d;
    float b = high / d;
    return vec2(min(a, b), max(a, b));
}

// The first axis on which `v` is `value`.
int axis_of(vec3 v, float value) {
    return v.x == value ? 0 : v.y == value ? 1 : 2;
}

Surface closest_surface(vec3 direction, float t_min) {
    vec3 d = object_direction(direction);
    vec2 x = between(box_min.x, box_max.x, d.x);
    vec2 y = between(box_min.y, box_max.y, d.y);
    vec2 z = between(box_min.z, box_max.z, d.z);
    float enter = max(x.x, max(y.x, z.x));
    float leave = min(x.y, min(y.y, z.y));
    Surface s;
    s.t = kMiss;
    s.primitive = 0u;
    s.material = kNoMaterial;
    if (!(enter <= leave)) return s;
    bool outside = enter > t_min;
    s.t = outside ? enter : leave;
    int axis = outside ? axis_of(vec3(x.x, y.x, z.x), enter) : axis_of(vec3(x.y, y.y, z.y), leave);
    // A ray that runs upwards enters through the lower face and leaves through the upper one.
    bool upper = (d[axis] > 0.0) != outside;
    s.primitive = uint(2 * axis + (upper ? 1 : 0));  // -x +x -y +y -z +z
    vec3 normal = vec3(0.0);
    normal[axis] = upper ? 1.0 : -1.0;
    s.geometric = scene_normal(normal);
    s.shading = s.geometric;
    return s;
}
