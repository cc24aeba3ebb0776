// Third pass: lights each pixel once.
#include "ray.glsl"
#include "phong.glsl"

uniform sampler2D normal_t;
uniform usampler2D material;
uniform samplerBuffer materials;  // four texels each; the last one is the default
uniform int material_count;       // without the default
uniform samplerBuffer lights;     // two texels each
uniform int light_count;
uniform vec3 ambient;
uniform vec3 background;

out vec4 colour_t;

Material fetch_material(uint id) {
    int i = 4 * int(min(id, uint(material_count)));
    vec4 ambient_shininess = texelFetch(materials, i);
    Material m;
    m.ambient = ambient_shininess.rgb;
    m.shininess = ambient_shininess.a;
    m.diffuse = texelFetch(materials, i + 1).rgb;
    m.specular = texelFetch(materials, i + 2).rgb;
    m.emissive = texelFetch(materials, i + 3).rgb;
    return m;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 n = texelFetch(normal_t, texel, 0);
    if (n.xyz == vec3(0.0)) {
        colour_t = vec4(background, n.w);
        return;
    }
    vec3 direction = eye_direction();
    vec3 point = n.w * direction;
    Material m = fetch_material(texelFetch(material, texel, 0).r);
    vec3 colour = m.emissive + m.ambient * ambient;
    for (int i = 0; i < light_count; ++i) {
        vec4 place = texelFetch(lights, 2 * i);  // w 1: a point relative to the eye; 0: a direction
        vec3 to_light = normalize(place.xyz - place.w * point);
        colour += texelFetch(lights, 2 * i + 1).rgb * phong(m, n.xyz, to_light, -direction);
    }
    colour_t = vec4(colour, n.w);
}
