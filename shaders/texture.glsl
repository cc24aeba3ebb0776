// Texture look-ups. The C++ twin is sample() in tracer/scene/texture.h: the same texels, the same
// formulas, so that the raster view and the traced image show the same.
uniform usamplerBuffer texture_table;  // see viewer/raster/gpu_textures.h
uniform samplerBuffer texels;

// A use of a texture: TextureMap in tracer/scene/texture.h.
struct TextureMap {
    int texture;  // -1: none
    vec3 u_row;
    vec3 v_row;
    int channel;
    bool nearest;
    int wrap_u;
    int wrap_v;
    float base;
    float gain;
};

const int kRepeat = 0;
const int kClamp = 1;
const int kMirror = 2;

const int kLinear = 1;  // TexelCoding; 0 is sRGB
const int kLogarithmic = 2;

// What a pixel covers of a surface in its uv: an ellipse's axes, full widths.
struct Footprint {
    vec2 major;
    vec2 minor;
};
const Footprint kNoFootprint = Footprint(vec2(0.0), vec2(0.0));

const float kLargestCoordinate = 1e9;  // beyond it, and for NaN, coordinates mean nothing
const int kMaxTaps = 16;

// The samples along the longer axis of a footprint that together cover it.
struct Taps {
    int count;
    float width;  // of one sample, across the longer axis; the unit is that of the axes
};

// At least `least` wide: what is narrower than a texel needs no more samples.
Taps taps_along(float longer, float shorter, float least) {
    Taps taps = Taps(1, max(max(shorter, longer / float(kMaxTaps)), least));
    if (!(taps.width < kLargestCoordinate)) return Taps(1, kLargestCoordinate);
    if (taps.width > 0.0) taps.count = clamp(int(ceil(longer / taps.width)), 1, kMaxTaps);
    return taps;
}

// Where the middle of sample i of n lies on an axis of full width 1 around 0.
float tap_offset(int i, int n) {
    return (float(i) + 0.5) / float(n) - 0.5;
}

// --- Images -------------------------------------------------------------------------------------

struct TextureImage {
    int coding;  // TexelCoding of tracer/scene/texel_coding.h
    int levels;
    int first_level;  // in texture_table
};

struct TextureLevel {
    int cols;
    int rows;
    int first;  // texel
};

TextureLevel texture_level(TextureImage image, int number) {
    uvec4 entry = texelFetch(texture_table, image.first_level + number);
    return TextureLevel(int(entry.x), int(entry.y), int(entry.z));
}

// Coordinate to [0, 1], or [0, 2] for mirrored images, whose second half is turned round.
float wrapped(float x, int wrap) {
    if (!(abs(x) < kLargestCoordinate)) return 0.0;
    if (wrap == kClamp) return clamp(x, 0.0, 1.0);
    return wrap == kMirror ? x - 2.0 * floor(0.5 * x) : x - floor(x);
}

// Texel i of n; i is at most one period outside what wrapped() leaves.
int wrapped_texel(int i, int n, int wrap) {
    if (wrap == kClamp) return clamp(i, 0, n - 1);
    if (wrap == kRepeat) return (i + n) % n;
    int in_period = (i + 2 * n) % (2 * n);
    return in_period < n ? in_period : 2 * n - 1 - in_period;
}

float linear_from_srgb(float c) {
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

vec4 texel(TextureImage image, TextureMap map, TextureLevel level, int col, int row) {
    int place = wrapped_texel(row, level.rows, map.wrap_v) * level.cols +
                wrapped_texel(col, level.cols, map.wrap_u);
    vec4 c = texelFetch(texels, level.first + place);
    if (image.coding == kLinear) return c;
    if (image.coding == kLogarithmic) return vec4(exp2(13.0 * (c.rgb - 1.0)), c.a);
    return vec4(linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b), c.a);
}

// Texels from the top left corner; row 0 is on top, where v is 1.
vec2 texel_place(vec2 t, TextureMap map, TextureLevel level) {
    return vec2(wrapped(t.x, map.wrap_u) * float(level.cols),
                (1.0 - wrapped(t.y, map.wrap_v)) * float(level.rows));
}

// How much of a bilinear look-up corner 0..3 (left to right, then the row below) is.
float corner_share(int corner, vec2 share) {
    return ((corner & 1) != 0 ? share.x : 1.0 - share.x) *
           ((corner & 2) != 0 ? share.y : 1.0 - share.y);
}

// Interpolated between four texels; the one at t alone if `nearest`.
vec4 at_point(TextureImage image, TextureMap map, vec2 t, int number, bool nearest) {
    TextureLevel level = texture_level(image, number);
    vec2 place = texel_place(t, map, level) - (nearest ? 0.0 : 0.5);
    ivec2 first = ivec2(floor(place));
    vec2 share = nearest ? vec2(0.0) : place - floor(place);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (nearest ? 1 : 4); ++i) {
        sum += corner_share(i, share) * texel(image, map, level, first.x + (i & 1),
                                              first.y + (i >> 1));
    }
    return sum;
}

// Trilinear. The filter `nearest` is for texels larger than pixels: smaller ones are averaged.
vec4 at_level(TextureImage image, TextureMap map, vec2 t, float level) {
    bool nearest = level == 0.0 && map.nearest;
    int finer = int(level);
    float fraction = level - float(finer);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (fraction == 0.0 ? 1 : 2); ++i)
        sum += (i == 0 ? 1.0 - fraction : fraction) * at_point(image, map, t, finer + i, nearest);
    return sum;
}

// Averages around t over the parallelogram of the axes a and b (texture coordinates). Each look-up
// is written once, in loops: functions are inlined, and compilers of software OpenGL take seconds
// for the many copies that there would be.
vec4 image_average(TextureImage image, TextureMap map, vec2 t, vec2 a, vec2 b) {
    TextureLevel level_0 = texture_level(image, 0);
    vec2 size = vec2(level_0.cols, level_0.rows);
    float length_a = length(a * size);
    float length_b = length(b * size);
    Taps taps = taps_along(max(length_a, length_b), min(length_a, length_b), 1.0);
    vec2 longer = length_b > length_a ? b : a;
    float level = min(log2(taps.width), float(image.levels - 1));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps.count; ++i)
        sum += at_level(image, map, t + tap_offset(i, taps.count) * longer, level);
    return sum / float(taps.count);
}

// --- Checker ------------------------------------------------------------------------------------

// The signs' integral from 0 on: a wave of triangles between 0 and 1.
float sign_integral(float end) {
    return 1.0 - abs(end - 2.0 * floor(0.5 * end) - 1.0);
}

// The mean over [x - w/2, x + w/2] of +1 where floor(x) is even and -1 where it is odd.
float mean_sign(float x, float w) {
    if (!(abs(x) < kLargestCoordinate)) return 0.0;
    float in_period = x - 2.0 * floor(0.5 * x);  // [0, 2]
    if (w < 1.0) {
        float sign = in_period < 1.0 || in_period >= 2.0 ? 1.0 : -1.0;
        if (!(w > 0.0)) return sign;
        // There is one edge at most within the width.
        float to_edge = abs(in_period - floor(in_period + 0.5));
        return sign * min(1.0, 2.0 * to_edge / w);
    }
    return (sign_integral(in_period + 0.5 * w) - sign_integral(in_period - 0.5 * w)) / w;
}

// How much of the parallelogram around t lies on even squares.
float even_share(vec2 t, vec2 a, vec2 b) {
    float length_a = length(a);
    float length_b = length(b);
    bool turned = length_b > length_a;
    vec2 longer = turned ? b : a;
    vec2 shorter = turned ? a : b;
    Taps taps = taps_along(max(length_a, length_b), min(length_a, length_b), 0.0);
    vec2 box = abs(longer) / float(taps.count) + abs(shorter);
    if (!(box.x < kLargestCoordinate && box.y < kLargestCoordinate)) return 0.5;
    float sum = 0.0;
    for (int i = 0; i < taps.count; ++i) {
        vec2 middle = t + tap_offset(i, taps.count) * longer;
        sum += mean_sign(middle.x, box.x) * mean_sign(middle.y, box.y);
    }
    return 0.5 + 0.5 * sum / float(taps.count);
}

// ------------------------------------------------------------------------------------------------

const uint kImageTexture = 0u;

// The map's texture around uv, averaged over the footprint: as it is, without base and gain.
vec4 sample_texel(TextureMap map, vec2 uv, Footprint covered) {
    vec2 t = vec2(dot(map.u_row, vec3(uv, 1.0)), dot(map.v_row, vec3(uv, 1.0)));
    vec2 a = vec2(dot(map.u_row.xy, covered.major), dot(map.v_row.xy, covered.major));
    vec2 b = vec2(dot(map.u_row.xy, covered.minor), dot(map.v_row.xy, covered.minor));
    uvec4 entry = texelFetch(texture_table, 3 * map.texture);
    if (entry.x == kImageTexture) {
        return image_average(TextureImage(int(entry.y), int(entry.z), int(entry.w)), map, t, a, b);
    }
    vec4 even = uintBitsToFloat(texelFetch(texture_table, 3 * map.texture + 1));
    vec4 odd = uintBitsToFloat(texelFetch(texture_table, 3 * map.texture + 2));
    return mix(odd, even, even_share(t, a, b));
}

// sample(): with the map's base and gain.
vec4 sample_map(TextureMap map, vec2 uv, Footprint covered) {
    return vec4(map.base) + map.gain * sample_texel(map, uv, covered);
}

// The uv that a step in the surface's plane leads to.
vec2 uv_step(vec3 dpdu, vec3 dpdv, vec3 step) {
    float uu = dot(dpdu, dpdu);
    float uv = dot(dpdu, dpdv);
    float vv = dot(dpdv, dpdv);
    float along_u = dot(dpdu, step);
    float along_v = dot(dpdv, step);
    return vec2(vv * along_u - uv * along_v, uu * along_v - uv * along_u) / (uu * vv - uv * uv);
}

// What a ray's cone of diameter `width` covers around the point, in uv. The C++ twin is footprint()
// in tracer/accel/surface.h. `normal` is the geometric one, unit, on either side.
Footprint footprint(vec3 normal, vec3 dpdu, vec3 dpdv, vec3 direction, float width) {
    float cosine = dot(normal, direction);
    vec3 across = cross(normal, direction);
    // Seen straight on the ellipse is a circle: any two directions do.
    if (!(dot(across, across) > 1e-12)) across = cross(normal, dpdu);
    across = normalize(across);
    vec3 along = cross(across, normal);
    float slant = max(abs(cosine), 1.0 / 64.0);
    vec2 major = uv_step(dpdu, dpdv, along * (width / slant));
    vec2 minor = uv_step(dpdu, dpdv, across * width);
    // Where dpdu and dpdv span no plane this is not a number.
    if (!(dot(major, major) < 1e36 && dot(minor, minor) < 1e36)) return kNoFootprint;
    return Footprint(major, minor);
}
