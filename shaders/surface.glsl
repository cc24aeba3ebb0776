// What a shape's file must give: where a ray meets it.
struct Surface {
    float t;         // along the unit scene ray: distance from the eye; anything not > 0 is a miss
    vec3 geometric;  // outward normal in scene space, any length
    vec3 shading;    // outward normal for lighting in scene space, any length
    uint primitive;
    uint material;  // 0xffffffff: a default
};

const uint kNoMaterial = 0xffffffffu;
const float kMiss = -1.0;

uniform mat3 object_from_scene;  // for vectors
uniform uint object_material;    // overrides what the shape says unless it is kNoMaterial

// The ray's direction in object space is not renormalised: t stays the scene's.
vec3 object_direction(vec3 direction) {
    return object_from_scene * direction;
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
