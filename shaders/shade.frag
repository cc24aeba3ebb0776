// Third pass: lights each pixel once.
#include "ray.glsl"
#include "environment.glsl"
#include "lights.glsl"
#include "materials.glsl"
#ifdef TEXTURED
#include "textured.glsl"
#endif

uniform sampler2D normal_t;
uniform usampler2D material;
#ifdef TEXTURED
uniform sampler2D uv;
uniform sampler2D footprint_axes;
#endif
uniform vec3 ambient;

out vec4 colour_t;

Material material_at(ivec2 texel) {
    uint id = texelFetch(material, texel, 0).r;
#ifdef TEXTURED
    vec4 axes = texelFetch(footprint_axes, texel, 0);
    return textured_material(id, texelFetch(uv, texel, 0).xy, Footprint(axes.xy, axes.zw));
#else
    return fetch_material(id);
#endif
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 n = texelFetch(normal_t, texel, 0);
    Ray ray = eye_ray();
    if (n.xyz == vec3(0.0)) {
        colour_t = vec4(environment_colour(ray.direction, cone_spread()), n.w);
        return;
    }
    Material m = material_at(texel);
    vec3 point = ray.origin + n.w * ray.direction;
    vec3 colour = m.emissive + m.ambient * ambient + lit(m, n.xyz, point, -ray.direction);
    colour_t = vec4(m.opacity * colour, n.w);
}
