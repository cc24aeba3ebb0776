// Normals from a material's normal map. The C++ twin is in tracer/shade/textured.h.
#include "materials.glsl"
#include "maps.glsl"

// The derivatives of a tiny mesh are tiny; only what no longer has a direction is left out.
bool has_direction(vec3 v) {
    return dot(v, v) > 1e-36;
}

// The outward shading normal after the material's normal map, which says x along the surface's u,
// y along its v and z along `normal` (outward, unit). Without a map, or where dpdu and dpdv span no
// plane, that is `normal` itself.
vec3 mapped_normal(Surface s, vec3 normal, Footprint covered) {
    int number = material_block(s.material);
    if (number < 0) return normal;
    MapBlock block = map_block(number);
    if (!has_map(block, kNormalMap)) return normal;
    vec3 along_u = s.dpdu - normal * dot(normal, s.dpdu);
    if (!has_direction(along_u)) return normal;
    along_u = normalize(along_u);
    vec3 along_v = s.dpdv - normal * dot(normal, s.dpdv);
    along_v -= along_u * dot(along_u, along_v);
    if (!has_direction(along_v)) return normal;
    along_v = normalize(along_v);
    // The gain scales the slopes, not the texel.
    TextureMap map = map_of(block, kNormalMap);
    vec3 slopes = 2.0 * sample_texel(map, s.uv, covered).xyz - 1.0;
    vec3 mapped = map.gain * (slopes.x * along_u + slopes.y * along_v) + slopes.z * normal;
    return has_direction(mapped) ? normalize(mapped) : normal;
}
