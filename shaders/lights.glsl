// The lights as they reach a point. The C++ twin is tracer/shade/light_sample.h; positions are
// relative to the eye here.
#include "local_light.glsl"

uniform samplerBuffer lights;  // kLightTexels each: see viewer/raster/gpu_lights.h
uniform int light_count;

const int kLightTexels = 5;
// The order of the alternatives of Light in tracer/scene/light.h.
const int kPointLight = 0;
const int kDirectionalLight = 1;
const int kSpotLight = 2;
const int kSphereLight = 3;
const int kRectangleLight = 4;

// 1 / (constant + linear d + quadratic d^2) at distance d.
float falloff(vec3 attenuation, float d) {
    return 1.0 / (attenuation.x + d * (attenuation.y + d * attenuation.z));
}

// Without SHAPED_LIGHTS there are point and directional lights only, and the rest is left out:
// software OpenGL runs every branch of an if.
#ifdef SHAPED_LIGHTS
// How much of a spot's light leaves against `to_light`, a unit direction. With equal angles the
// edge is sharp.
float spot_share(int first, vec3 to_light) {
    vec4 axis_outer = texelFetch(lights, first + 3);
    float inner = texelFetch(lights, first + 4).w;
    float outer = axis_outer.w;
    float cosine = -dot(axis_outer.xyz, to_light);
    if (cosine >= inner) return 1.0;
    if (!(cosine > outer)) return 0.0;
    float share = (cosine - outer) / (inner - outer);
    return share * share;
}

// The middle of cell i of the n x n cells of the unit square.
vec2 cell_centre(int i, int n) {
    return (vec2(i % n, i / n) + 0.5) / float(n);
}

// Two unit vectors perpendicular to a unit vector and to each other. Source: Duff et al., "Building
// an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
mat2x3 axes_across(vec3 n) {
    float side = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + n.z);
    float b = n.x * n.y * a;
    return mat2x3(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x),
                  vec3(b, side + n.y * n.y * a, -n.y));
}

// Maps the unit square to the unit disk, equal areas to equal areas. Source: Shirley, Chiu, "A Low
// Distortion Map Between Disk and Square", JGT 2(3), 1997.
vec2 disk_from_square(vec2 square) {
    vec2 p = 2.0 * square - 1.0;
    if (p == vec2(0.0)) return vec2(0.0);
    const float kQuarterPi = 0.785398163397448;
    bool across = abs(p.x) > abs(p.y);
    float radius = across ? p.x : p.y;
    float angle = across ? kQuarterPi * (p.y / p.x)
                              : 2.0 * kQuarterPi - kQuarterPi * (p.x / p.y);
    return radius * vec2(cos(angle), sin(angle));
}

// From the lit point to one point of a light that is no directional one; `offset` leads to its
// place. Area lights take the centres of the cells that the tracer's samples lie in.
vec3 sample_offset(int first, int kind, vec3 offset, int i, int samples, float radius) {
    if (kind == kSphereLight) {
        // Spread over the disk that faces the lit point.
        return offset + axes_across(normalize(offset)) *
                            (radius * disk_from_square(cell_centre(i, samples)));
    }
    if (kind == kRectangleLight) {
        vec2 place = cell_centre(i, samples) - 0.5;
        return offset + place.x * texelFetch(lights, first + 3).xyz +
               place.y * texelFetch(lights, first + 4).xyz;
    }
    return offset;
}
#endif

// What one light makes the surface at `point` give off towards the eye.
vec3 from_light(Material m, vec3 normal, vec3 point, vec3 to_eye, int first) {
    vec4 place_kind = texelFetch(lights, first);
    vec4 colour_samples = texelFetch(lights, first + 1);
    vec4 attenuation_radius = texelFetch(lights, first + 2);
    int kind = int(place_kind.w);
#ifdef SHAPED_LIGHTS
    int samples = max(int(colour_samples.w), 1);
#else
    const int samples = 1;
#endif
    vec3 sum = vec3(0.0);
    for (int i = 0; i < samples * samples; ++i) {
        vec3 to_light = place_kind.xyz;
        float share = 1.0;
        if (kind != kDirectionalLight) {
            vec3 offset = place_kind.xyz - point;
#ifdef SHAPED_LIGHTS
            offset = sample_offset(first, kind, offset, i, samples, attenuation_radius.w);
#endif
            float d = length(offset);
            if (!(d > 0.0)) continue;
            to_light = offset / d;
            share = falloff(attenuation_radius.xyz, d);
#ifdef SHAPED_LIGHTS
            if (kind == kSpotLight) share *= spot_share(first, to_light);
#endif
        }
        sum += share * local_light(m, normal, to_light, to_eye);
    }
    return colour_samples.rgb * (sum / float(samples * samples));
}

// All lights together.
vec3 lit(Material m, vec3 normal, vec3 point, vec3 to_eye) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < light_count; ++i)
        sum += from_light(m, normal, point, to_eye, kLightTexels * i);
    return sum;
}
