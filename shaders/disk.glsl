// A disk of radius 1 around 0, facing +y, exactly; with a hole if disk_inner_radius > 0.
uniform float disk_inner_radius;

Surface closest_surface(Ray ray) {
    UnitRay local = unit_ray(ray);
    Surface s = no_surface();
    s.t = -local.origin.y / local.direction.y;
    if (!(s.t > ray.t_min)) return no_surface();
    vec2 p = local.origin.xz + s.t * local.direction.xz;
    float distance = length(p);
    if (!(distance >= disk_inner_radius && distance <= 1.0)) return no_surface();
    s.geometric = scene_normal(vec3(0.0, 1.0, 0.0));
    s.shading = s.geometric;
    s.front = local.direction.y < 0.0;
#ifdef TEXTURED
    Around around = around_axis(p);
    float there = distance > 0.0 ? 1.0 : 0.0;  // the centre has no angle
    set_texture_frame(s, vec2(around.turn, distance),
                      kTurn * distance * vec3(around.along.x, 0.0, around.along.y),
                      there * vec3(around.away.x, 0.0, around.away.y));
#endif
    if (is_there(s)) return s;
    return no_surface();
}
