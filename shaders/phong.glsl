// Phong's local term. The C++ twin is phong() in tracer/shade/trace.h.
struct Material {
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    float shininess;
    vec3 emissive;
};

// What reaches the eye of a light of colour 1; 0 if it shines from behind. All directions are unit; `normal` is on the eye's
// side.
vec3 phong(Material m, vec3 normal, vec3 to_light, vec3 to_eye) {
    float n_dot_l = dot(normal, to_light);
    if (!(n_dot_l > 0.0)) return vec3(0.0);
    vec3 reflected = 2.0 * n_dot_l * normal - to_light;
    float lobe = dot(reflected, to_eye);
    float highlight = lobe > 0.0 ? pow(lobe, m.shininess) : 0.0;
    return m.diffuse * n_dot_l + m.specular * highlight;
}
