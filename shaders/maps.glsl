// The texture maps of a material: see viewer/raster/gpu_materials.h.
#include "texture.glsl"

uniform samplerBuffer maps;

// MapSlot of tracer/scene/material.h.
const int kDiffuseMap = 0;
const int kSpecularMap = 1;
const int kShininessMap = 2;
const int kReflectMap = 3;
const int kTransmitMap = 4;
const int kOpacityMap = 5;
const int kEmissiveMap = 6;
const int kNormalMap = 7;
const int kAmbientMap = 8;
const int kMapSlots = 9;

// What stands before a material's maps.
struct MapBlock {
    int first;       // texel of the block
    float opacity;   // of the material without its map
    float vanishing;  // below this opacity there is no surface
    bool blended;
    int present;     // bit s: there is a map in slot s
};

MapBlock map_block(int number) {
    int first = number * (1 + 3 * kMapSlots);
    vec4 head = texelFetch(maps, first);
    return MapBlock(first, head.x, head.y, head.z != 0.0, int(head.w));
}

bool has_map(MapBlock block, int slot) {
    return (block.present >> slot & 1) != 0;
}

TextureMap map_of(MapBlock block, int slot) {
    int first = block.first + 1 + 3 * slot;
    vec4 u_row = texelFetch(maps, first);
    vec4 v_row = texelFetch(maps, first + 1);
    vec4 range = texelFetch(maps, first + 2);
    int modes = int(v_row.w);
    return TextureMap(int(u_row.w), u_row.xyz, v_row.xyz, modes & 3, (modes >> 2 & 1) != 0,
                      modes >> 3 & 3, modes >> 5 & 3, range.x, range.y);
}

// What a map of one number multiplies by; 1 without one.
float map_number(MapBlock block, int slot, vec2 uv, Footprint covered) {
    if (!has_map(block, slot)) return 1.0;
    TextureMap map = map_of(block, slot);
    return sample_map(map, uv, covered)[map.channel];
}
