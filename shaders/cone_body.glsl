// A truncated cone as the convex body between its caps, as tracer/geometry/cone.cpp: the part of
// the ray between the planes and the part within the side are intervals, and the body is where they
// overlap.

// Its space is scaled so that nothing in it is much larger than 1.
struct ConeBody {
    vec3 axis;  // unit, from base to apex
    float length;
    float base_radius;
    float apex_radius;
    bool capped;
#ifdef TEXTURED
    vec3 x;  // of its axis frame, unit
#endif
};

const vec2 kNowhere = vec2(3e38, -3e38);

// Within the side's infinite cone, on the nappe that the planes cut out: where
//   |across + t drift|^2 <= (radius + t growth)^2,  radius + t growth >= 0.
vec2 within_side(vec3 across, vec3 drift, float radius, float growth) {
    float speed = length(drift);
    float distance = length(across);
    float a = (speed - abs(growth)) * (speed + abs(growth));
    float b = dot(across, drift) - growth * radius;
    float c = (distance - radius) * (distance + radius);
    if (a == 0.0) {  // parallel to the side: one root, or none
        if (b == 0.0) return c <= 0.0 ? -kNowhere : kNowhere;
        float root = -0.5 * c / b;
        return b > 0.0 ? vec2(-3e38, root) : vec2(root, 3e38);
    }
    float discriminant = b * b - a * c;
    // Steeper than the side it meets both nappes: then only rounding makes this negative.
    if (a > 0.0 && !(discriminant >= 0.0)) return kNowhere;
    float root = sqrt(max(discriminant, 0.0));
    float q = -(b < 0.0 ? b - root : b + root);
    float t0 = q / a;
    float t1 = q != 0.0 ? c / q : t0;
    if (a > 0.0) return vec2(min(t0, t1), max(t0, t1));
    return growth > 0.0 ? vec2(max(t0, t1), 3e38) : vec2(-3e38, min(t0, t1));
}

#ifdef TEXTURED
// As cone_point of tracer/accel/local_point.cpp. `across` leads from the axis to the point.
void set_cone_frame(inout Surface s, ConeBody cone, int part, vec3 across, float height,
                    float scale) {
    vec3 z = cross(cone.x, cone.axis);
    Around around = around_axis(vec2(dot(across, cone.x), dot(across, z)));
    vec3 away = around.away.x * cone.x + around.away.y * z;
    vec3 along = around.along.x * cone.x + around.along.y * z;
    if (part == 0) {
        float share = clamp(height / cone.length, 0.0, 1.0);
        float widening = cone.apex_radius - cone.base_radius;
        float radius = cone.base_radius + share * widening;
        float there = radius > 0.0 ? scale : 0.0;  // a tip has no derivatives
        set_texture_frame(s, vec2(around.turn, share), there * kTurn * radius * along,
                          there * (cone.length * cone.axis + widening * away));
    } else {
        float rim = part == 1 ? cone.base_radius : cone.apex_radius;
        float distance = min(length(across), rim);
        float there = distance > 0.0 ? scale : 0.0;
        set_texture_frame(s, vec2(around.turn, distance / rim), there * kTurn * distance * along,
                          there * rim * away);
    }
}
#endif

// `origin` is the ray's, seen from the base's centre, and `direction` its direction, both in the
// cone's space, which is object space divided by `scale`. `element`: the cone's number in a set,
// which then is the primitive; -1: the primitive is the side 0, the base's cap 1, the apex's 2.
Surface closest_on_cone(Ray ray, vec3 origin, vec3 direction, ConeBody cone, float scale,
                        int element, uint material) {
    float speed = length(direction);
    vec3 d = direction / speed;
    // Counted from the point nearest to the cone's middle, so that far origins cost no precision.
    float start = dot(0.5 * cone.length * cone.axis - origin, d);
    vec3 p = origin + start * d;
    float height = dot(p, cone.axis);
    float climb = dot(d, cone.axis);
    vec3 across = p - height * cone.axis;
    vec3 drift = d - climb * cone.axis;
    vec2 planes = between(-height, cone.length - height, climb);
    if (!(planes.x <= planes.y)) return no_surface();

    // Then from the point nearest to the axis between the planes.
    float squared_drift = dot(drift, drift);
    float nearest = squared_drift > 0.0 ? -dot(across, drift) / squared_drift : 0.0;
    nearest = clamp(nearest, planes.x, planes.y);
    start += nearest;
    height += nearest * climb;
    across += nearest * drift;
    planes -= nearest;
    float widest = max(cone.base_radius, cone.apex_radius);
    if (!(dot(across, across) <= widest * widest)) return no_surface();
    float widening = (cone.apex_radius - cone.base_radius) / cone.length;
    vec2 side =
        within_side(across, drift, cone.base_radius + widening * height, widening * climb);
    vec2 body = vec2(max(planes.x, side.x), min(planes.y, side.y));
    if (!(body.x <= body.y && body.x > -1e38 && body.y < 1e38)) return no_surface();

    for (int i = 0; i < 2; ++i) {
        float t = i == 0 ? body.x : body.y;
        bool at_base = (i == 0) == (climb > 0.0);
        float rim = at_base ? cone.base_radius : cone.apex_radius;
        bool on_side = rim == 0.0 || (i == 0 ? side.x >= planes.x : side.y <= planes.y);
        if (!on_side && !cone.capped) continue;
        Surface s = no_surface();
        s.t = (start + t) / speed;
        if (!(s.t > ray.t_min)) continue;
        vec3 at = across + t * drift;
        float distance = length(at);
        vec3 normal = at_base ? -cone.axis : cone.axis;
        if (on_side) {
            // At the tip of a cone the axis stands in for the normal.
            normal = distance > 0.0 ? at / distance - widening * cone.axis
                                    : (widening < 0.0 ? cone.axis : -cone.axis);
        }
        int part = on_side ? 0 : at_base ? 1 : 2;
        s.geometric = scene_normal(normal);
        s.shading = s.geometric;
        s.front = dot(normal, d) < 0.0;
        s.primitive = uint(element >= 0 ? element : part);
        s.material = material;
#ifdef TEXTURED
        set_cone_frame(s, cone, part, at, height + t * climb, scale);
#endif
        if (is_there(s)) return s;
    }
    return no_surface();
}
