// A ring torus around +y with major radius 1, exactly. As tracer/geometry/torus.cpp: its quartic
// only says where to look. Between the zeros of the quartic's derivative there is at most one root
// each; whether there is one, and where, is decided by the distance to the tube, which keeps its
// precision in floats where the quartic's coefficients cancel.
uniform float torus_minor_radius;

// The ray in units of the major radius, starting nearest to the centre.
struct TorusRay {
    vec3 origin;
    vec3 direction;  // unit
};

// How much farther than the torus reaches it is looked for, so that both ends are surely outside.
const float kMargin = 1.0 + 1e-5;

// Squared distance from the tube's circle, less the tube's own (negative inside), and its slope.
vec2 beyond(TorusRay ray, float t) {
    vec3 p = ray.origin + t * ray.direction;
    float from_axis = length(p.xz);
    float from_ring = from_axis - 1.0;
    float outwards = from_axis > 0.0 ? dot(p.xz, ray.direction.xz) / from_axis : 0.0;
    return vec2(from_ring * from_ring + p.y * p.y - torus_minor_radius * torus_minor_radius,
                2.0 * (from_ring * outwards + p.y * ray.direction.y));
}

// The derivative of the quartic (|p|^2 + 1 - r^2)^2 - 4 (p.x^2 + p.z^2) along the ray: coefficients
// of 1, t, t^2 and t^3.
vec4 quartic_slope(TorusRay ray) {
    float b = dot(ray.origin, ray.direction);  // 0 but for rounding
    float k = dot(ray.origin, ray.origin) + 1.0 - torus_minor_radius * torus_minor_radius;
    float a = dot(ray.direction.xz, ray.direction.xz);
    float e = dot(ray.origin.xz, ray.direction.xz);
    return vec4(4.0 * b * k - 8.0 * e, 8.0 * b * b + 4.0 * k - 8.0 * a, 12.0 * b, 4.0);
}

// Value and slope at t of the cubic, or of the distance to the tube.
vec2 at_place(TorusRay ray, vec4 cubic, bool tube, float t) {
    if (tube) return beyond(ray, t);
    return vec2(cubic.x + t * (cubic.y + t * (cubic.z + t * cubic.w)),
                cubic.y + t * (2.0 * cubic.z + t * 3.0 * cubic.w));
}

// The root between two places where the function has different signs (positive and not positive):
// Newton's method, bisecting where it would leave the bracket or converges slowly. Source: Press et
// al., Numerical Recipes, 3rd ed. 2007, section 9.4.
float root_between(TorusRay ray, vec4 cubic, bool tube, float not_positive, float positive) {
    const int kMaxSteps = 60;
    float x = 0.5 * (not_positive + positive);
    float last_step = abs(positive - not_positive);
    for (int i = 0; i < kMaxSteps; ++i) {
        vec2 f = at_place(ray, cubic, tube, x);
        if (f.x > 0.0) {
            positive = x;
        } else {
            not_positive = x;
        }
        float middle = 0.5 * (not_positive + positive);
        float next = middle;
        if (f.y != 0.0) {
            float newton = x - f.x / f.y;
            bool inside = (newton - not_positive) * (newton - positive) < 0.0;
            if (inside && abs(newton - x) < 0.5 * last_step) next = newton;
        }
        last_step = abs(next - x);
        if (last_step <= 3e-8 * abs(x) || next == not_positive || next == positive) return next;
        x = next;
    }
    return x;
}

// Ascending numbers: two ends and at most four between them.
struct Breaks {
    float at[6];
    int count;
};

// The ends of `breaks` with the function's sign changes between consecutive breaks.
Breaks zeros_between(TorusRay ray, vec4 cubic, bool tube, Breaks breaks) {
    Breaks zeros;
    zeros.at[0] = breaks.at[0];
    zeros.count = 1;
    bool low_positive = at_place(ray, cubic, tube, breaks.at[0]).x > 0.0;
    for (int i = 1; i < breaks.count; ++i) {
        float low = breaks.at[i - 1];
        float high = breaks.at[i];
        bool high_positive = at_place(ray, cubic, tube, high).x > 0.0;
        if (low_positive != high_positive) {
            zeros.at[zeros.count++] =
                root_between(ray, cubic, tube, low_positive ? high : low, low_positive ? low : high);
        }
        low_positive = high_positive;
    }
    zeros.at[zeros.count++] = breaks.at[breaks.count - 1];
    return zeros;
}

// Beginning and end of the part of the ray where the torus can be; count 0 if it passes by.
Breaks torus_reach(TorusRay ray) {
    Breaks ends;
    ends.count = 0;
    float far = (1.0 + torus_minor_radius) * kMargin;
    float squared = far * far - dot(ray.origin, ray.origin);
    if (!(squared >= 0.0)) return ends;
    float half_way = sqrt(squared);
    float height = torus_minor_radius * kMargin + 1e-6;
    vec2 within = between(-height - ray.origin.y, height - ray.origin.y, ray.direction.y);
    ends.at[0] = max(-half_way, within.x);
    ends.at[1] = min(half_way, within.y);
    if (ends.at[0] < ends.at[1]) ends.count = 2;
    return ends;
}

// The ends with the places between them where the cubic's own derivative is 0.
Breaks inflections(vec4 cubic, Breaks ends) {
    Breaks breaks;
    breaks.at[0] = ends.at[0];
    breaks.count = 1;
    float middle = -cubic.z / (3.0 * cubic.w);
    float squared = middle * middle - cubic.y / (3.0 * cubic.w);
    float root = sqrt(max(squared, 0.0));
    for (int i = 0; i < 2; ++i) {
        float t = i == 0 ? middle - root : middle + root;
        if (squared > 0.0 && t > ends.at[0] && t < ends.at[1]) breaks.at[breaks.count++] = t;
    }
    breaks.at[breaks.count++] = ends.at[1];
    return breaks;
}

#ifdef TEXTURED
// As torus_point of tracer/accel/local_point.cpp.
void set_torus_frame(inout Surface s, vec3 p, vec3 away, vec3 normal) {
    float from_axis = length(p.xz);
    vec3 along = vec3(-away.z, 0.0, away.x);
    float out_share = dot(normal, away);
    set_texture_frame(s, vec2(turn(p.x, p.z), turn(from_axis - 1.0, p.y)),
                      kTurn * (1.0 + torus_minor_radius * out_share) * along,
                      kTurn * torus_minor_radius *
                          (out_share * vec3(0.0, 1.0, 0.0) - normal.y * away));
}
#endif

Surface closest_surface(Ray ray) {
    UnitRay local = unit_ray(ray);
    float speed = length(local.direction);
    vec3 d = local.direction / speed;
    float start = -dot(local.origin, d);
    TorusRay along = TorusRay(local.origin + start * d, d);
    Breaks ends = torus_reach(along);
    if (ends.count == 0) return no_surface();
    // First the turning points of the quartic, then the roots between them. Each look for zeros is
    // written once, in a loop, as compilers of software OpenGL copy functions.
    vec4 cubic = quartic_slope(along);
    Breaks places = inflections(cubic, ends);
    for (int stage = 0; stage < 2; ++stage)
        places = zeros_between(along, cubic, stage == 1, places);
    for (int i = 1; i + 1 < places.count; ++i) {
        float t = places.at[i];
        Surface s = no_surface();
        s.t = (start + t) / speed;
        if (!(s.t > ray.t_min)) continue;
        vec3 p = along.origin + t * d;
        float from_axis = length(p.xz);
        vec3 away = from_axis > 0.0 ? vec3(p.x / from_axis, 0.0, p.z / from_axis) : vec3(0.0);
        vec3 normal = p - away;
        s.geometric = scene_normal(normal);
        s.shading = s.geometric;
        s.front = dot(normal, d) < 0.0;
#ifdef TEXTURED
        set_torus_frame(s, p, away, normalize(normal));
#endif
        if (is_there(s)) return s;
    }
    return no_surface();
}
