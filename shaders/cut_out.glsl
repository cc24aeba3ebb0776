// Where a surface is not there although its shape is. The tracer's rays pass through the same
// points, by the same look-up: of the point alone, without a footprint.
#include "materials.glsl"
#include "maps.glsl"

// Of a surface whose material and uv are set.
bool cut_out(Surface s) {
    int number = material_block(s.material);
    if (number < 0) return false;
    MapBlock block = map_block(number);
    return block.opacity * map_number(block, kOpacityMap, s.uv, kNoFootprint) < block.vanishing;
}
