// The square [0, 1] x [0, 1] in x and y, facing +z, exactly.
// What a ray's point may be off by for rounding alone. Rays that pass an edge by less than that
// meet the square, so that none slips between two that share it.
const float kRounding = 1.0 / 4194304.0;  // 2^-22

Surface closest_surface(Ray ray) {
    UnitRay local = unit_ray(ray);
    Surface s = no_surface();
    s.t = -local.origin.z / local.direction.z;
    if (!(s.t > ray.t_min)) return no_surface();
    vec2 way = s.t * local.direction.xy;
    vec2 p = local.origin.xy + way;
    vec2 slack = kRounding * (abs(local.origin.xy) + abs(way));
    if (!(all(greaterThanEqual(p, -slack)) && all(lessThanEqual(p, 1.0 + slack)))) {
        return no_surface();
    }
    s.geometric = scene_normal(vec3(0.0, 0.0, 1.0));
    s.shading = s.geometric;
    s.front = local.direction.z < 0.0;
#ifdef TEXTURED
    set_texture_frame(s, clamp(p, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
#endif
    if (is_there(s)) return s;
    return no_surface();
}
