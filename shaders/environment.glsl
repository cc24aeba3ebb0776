// What rays see that hit nothing. The C++ twin is environment_colour() in
// tracer/scene/environment.h.
uniform int sky_kind;     // the index of Environment's alternative
uniform vec3 background;  // kConstantSky
uniform vec3 zenith;      // kGradientSky, also the next two
uniform vec3 horizon;
uniform vec3 ground;
uniform vec3 sky_up;             // unit; with the next two an orthonormal frame
#ifdef IMAGE_SKY                 // all that follows: software OpenGL runs every branch of an if
uniform vec3 sky_right;          // kImageSky
uniform vec3 sky_forward;
uniform float sky_scale;
uniform ivec2 sky_size;          // columns and rows of the finest level
uniform int sky_levels;
uniform samplerBuffer sky_texels;  // all levels, the finest first
#endif

const int kConstantSky = 0;
const int kGradientSky = 1;
const int kImageSky = 2;

vec3 gradient(vec3 direction) {
    float height = dot(direction, sky_up);
    return mix(horizon, height < 0.0 ? ground : zenith, min(1.0, abs(height)));
}

#ifdef IMAGE_SKY
const float kPi = 3.14159265358979;
const int kMaxSkyTaps = 16;

struct SkyLevel {
    ivec2 size;
    int first;  // texel
};

// Each level is half the one before, rounded down, at least 1.
SkyLevel sky_level(int number) {
    SkyLevel level = SkyLevel(sky_size, 0);
    for (int i = 0; i < number; ++i) {
        level.first += level.size.x * level.size.y;
        level.size = max(level.size / 2, ivec2(1));
    }
    return level;
}

// Beyond a pole the image goes on upside down on the other side of the sphere.
vec3 sky_texel(SkyLevel level, int row, int col) {
    int rows = level.size.y;
    int cols = level.size.x;
    if (row < 0 || row >= rows) {
        row = row < 0 ? -1 - row : 2 * rows - 1 - row;
        col += cols / 2;
    }
    col = (col + 2 * cols) % cols;
    return texelFetch(sky_texels, level.first + row * cols + col).rgb;
}

// Interpolated between four texels. u and v run from 0 to 1 over columns and rows.
vec3 sky_bilinear(int number, vec2 uv) {
    SkyLevel level = sky_level(number);
    vec2 from_corner = uv * vec2(level.size) - 0.5;
    vec2 corner = floor(from_corner);
    vec2 share = from_corner - corner;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 part = mix(1.0 - share, share, vec2(i & 1, i >> 1));
        ivec2 place = ivec2(corner) + ivec2(i & 1, i >> 1);
        sum += part.x * part.y * sky_texel(level, place.y, place.x);
    }
    return sum;
}

vec3 sky_trilinear(float level, vec2 uv) {
    int finer = int(level);
    float fraction = level - float(finer);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < (fraction == 0.0 ? 1 : 2); ++i)
        sum += (i == 0 ? 1.0 - fraction : fraction) * sky_bilinear(finer + i, uv);
    return sum;
}

// Rows are as far apart everywhere, so they choose the level; towards the poles the same angle
// covers more and more columns, which more samples along the row make up for.
vec3 sky_average(vec2 uv, float spread, float cos_height) {
    float rows = spread / kPi * float(sky_size.y);
    float level = rows > 1.0 ? min(log2(rows), float(sky_levels - 1)) : 0.0;
    float wide = min(1.0, spread / (2.0 * kPi * max(cos_height, 1e-6)));
    float texels = wide * float(sky_size.x) / max(rows, 1.0);
    int taps = clamp(int(ceil(texels)), 1, kMaxSkyTaps);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < taps; ++i) {
        float offset = (float(i) + 0.5) / float(taps) - 0.5;
        sum += sky_trilinear(level, uv + vec2(wide * offset, 0.0));
    }
    return sum / float(taps);
}

vec3 image_sky(vec3 direction, float spread) {
    float x = dot(direction, sky_right);
    float y = clamp(dot(direction, sky_up), -1.0, 1.0);
    float z = dot(direction, sky_forward);
    float cos_height = sqrt(x * x + z * z);
    vec2 uv = vec2(0.5 + atan(x, z) / (2.0 * kPi), atan(cos_height, y) / kPi);
    return sky_scale * sky_average(uv, spread, cos_height);
}
#endif

// Linear RGB along a unit direction; images are averaged over the angle `spread`.
vec3 environment_colour(vec3 direction, float spread) {
    if (sky_kind == kGradientSky) return gradient(direction);
#ifdef IMAGE_SKY
    if (sky_kind == kImageSky) return image_sky(direction, spread);
#endif
    return background;
}
