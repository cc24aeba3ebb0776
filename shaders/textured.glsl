// A material after its maps. The C++ twin is tracer/shade/textured.h.
#include "materials.glsl"
#include "maps.glsl"

void multiply(inout Material m, int slot, vec3 colour, float number, bool ambient_apart) {
    if (slot == kDiffuseMap) m.diffuse *= colour;
    if (slot == (ambient_apart ? kAmbientMap : kDiffuseMap)) m.ambient *= colour;
    if (slot == kSpecularMap) m.specular *= colour;
    if (slot == kShininessMap) m.shininess = max(m.shininess * number, min(m.shininess, 1.0));
    if (slot == kEmissiveMap) m.emissive *= colour;
    if (slot == kOpacityMap) m.opacity *= number;
}

// What says how the surface itself looks; of these, a cut-out's opacity says only where it is.
int looked_up(MapBlock block) {
    int shown = 1 << kDiffuseMap | 1 << kSpecularMap | 1 << kShininessMap | 1 << kEmissiveMap |
                1 << kAmbientMap;
    if (block.blended) shown |= 1 << kOpacityMap;
    return block.present & shown;
}

Material textured_material(uint id, vec2 uv, Footprint covered) {
    Material m = fetch_material(id);
    int number = material_block(id);
    if (number < 0) return m;
    MapBlock block = map_block(number);
    int slots = looked_up(block);
    for (int slot = 0; slot < kMapSlots; ++slot) {
        if ((slots >> slot & 1) == 0) continue;
        TextureMap map = map_of(block, slot);
        vec4 value = sample_map(map, uv, covered);
        multiply(m, slot, value.rgb, value[map.channel], has_map(block, kAmbientMap));
    }
    m.opacity = clamp(m.opacity, 0.0, 1.0);
    return m;
}
