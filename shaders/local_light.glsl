// What a surface gives off towards the eye under one light. The C++ twins are phong() and
// blinn_phong() in tracer/shade.
struct Material {
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    float shininess;
    vec3 emissive;
    bool blinn;     // Blinn-Phong's highlight instead of Phong's
    float opacity;  // of a blended material; 1 on all others
};

// A highlight's base raised to the shininess. GLSL leaves pow(0, 0) undefined, so both sides take
// 0 where the eye is not in the lobe. A cosine rounded to more than 1 would grow beyond bounds.
float lobe_power(float lobe, float shininess) {
    return lobe > 0.0 ? pow(min(lobe, 1.0), shininess) : 0.0;
}

// R.V, with R the mirrored direction to the light.
float phong_lobe(vec3 normal, float n_dot_l, vec3 to_light, vec3 to_eye) {
    return dot(2.0 * n_dot_l * normal - to_light, to_eye);
}

// N.H, with H halfway between light and eye.
float blinn_phong_lobe(vec3 normal, vec3 to_light, vec3 to_eye) {
    vec3 halfway = to_light + to_eye;
    float size = length(halfway);
    return size > 0.0 ? dot(normal, halfway / size) : 0.0;
}

// Diffuse and specular terms for a light of colour 1; 0 if it shines from behind. All directions
// are unit; `normal` is on the eye's side.
vec3 local_light(Material m, vec3 normal, vec3 to_light, vec3 to_eye) {
    float n_dot_l = dot(normal, to_light);
    if (!(n_dot_l > 0.0)) return vec3(0.0);
    float lobe = m.blinn ? blinn_phong_lobe(normal, to_light, to_eye)
                         : phong_lobe(normal, n_dot_l, to_light, to_eye);
    return m.diffuse * n_dot_l + m.specular * lobe_power(lobe, m.shininess);
}
