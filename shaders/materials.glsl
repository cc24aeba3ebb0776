// The scene's materials: see viewer/raster/gpu_materials.h.
#include "local_light.glsl"

uniform samplerBuffer materials;  // four texels each; the last one is the default
uniform int material_count;       // without the default

int material_texel(uint id) {
    return 4 * int(min(id, uint(material_count)));
}

// The number of the material's block in maps.glsl; -1: it looks the same everywhere.
int material_block(uint id) {
    return int(texelFetch(materials, material_texel(id) + 3).w);
}

// Without its maps.
Material fetch_material(uint id) {
    int i = material_texel(id);
    vec4 ambient_shininess = texelFetch(materials, i);
    vec4 diffuse_blinn = texelFetch(materials, i + 1);
    vec4 specular_opacity = texelFetch(materials, i + 2);
    Material m;
    m.ambient = ambient_shininess.rgb;
    m.shininess = ambient_shininess.a;
    m.diffuse = diffuse_blinn.rgb;
    m.blinn = diffuse_blinn.a != 0.0;
    m.specular = specular_opacity.rgb;
    m.opacity = specular_opacity.a;
    m.emissive = texelFetch(materials, i + 3).rgb;
    return m;
}
