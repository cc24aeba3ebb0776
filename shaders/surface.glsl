// What a shape's file must give: where a ray meets it.
struct Surface {
    float t;         // along the unit scene ray; anything not > 0 is a miss
    vec3 geometric;  // outward normal in scene space, any length
    vec3 shading;    // outward normal for lighting in scene space, any length
    bool front;      // the ray meets the side that the outward normal points to
    uint primitive;
    uint material;  // 0xffffffff: a default
#ifdef TEXTURED
    // As texture_uv, dpdu and dpdv of SurfacePoint (tracer/accel/surface.h).
    vec2 uv;
    vec3 dpdu;  // scene space; 0 where there is none
    vec3 dpdv;
#endif
};

const uint kNoMaterial = 0xffffffffu;
const float kMiss = -1.0;

uniform mat3 object_from_scene;  // for vectors
#ifdef TEXTURED
uniform mat3 scene_from_object;
#endif
uniform uint object_material;  // overrides what the shape says unless it is kNoMaterial
uniform int sides;             // that are there: 0 both, 1 the front, 2 the back

Surface no_surface() {
    Surface s;
    s.t = kMiss;
    s.geometric = vec3(0.0);
    s.shading = vec3(0.0);
    s.front = false;
    s.primitive = 0u;
    s.material = kNoMaterial;
#ifdef TEXTURED
    s.uv = vec2(0.0);
    s.dpdu = vec3(0.0);
    s.dpdv = vec3(0.0);
#endif
    return s;
}

// A vector in object space, not renormalised: t stays the scene's.
vec3 object_vector(vec3 v) {
    return object_from_scene * v;
}

// Normals go by the inverse transpose.
vec3 scene_normal(vec3 object_normal) {
    return object_normal * object_from_scene;
}

float largest(vec3 v) {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

// normalize() whose squares neither overflow nor vanish.
vec3 unit(vec3 v) {
    return normalize(v / largest(v));
}

#ifdef TEXTURED
const float kTurn = 6.28318530717959;  // 2 pi

void set_texture_frame(inout Surface s, vec2 uv, vec3 object_dpdu, vec3 object_dpdv) {
    s.uv = uv;
    s.dpdu = scene_from_object * object_dpdu;
    s.dpdv = scene_from_object * object_dpdv;
}
#endif
