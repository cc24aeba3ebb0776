// Puts a frame on the screen: linear colour as sRGB and, if OUTLINES is defined, outlines around
// selected and hovered objects. Without a GPU even outlines around nothing take longer than the rest.
uniform sampler2D colour;
uniform usampler2D object;
uniform ivec2 frame_size;      // of the textures: columns and rows
uniform vec2 view_origin;      // bottom left corner of the view in the framebuffer
uniform vec2 view_size;        // pixels
uniform int block;  // side of the square of pixels that a texel fills, from the view's top left
                    // corner on; 0: the frame is stretched over the view
uniform usamplerBuffer selected;  // ascending ids
uniform int selected_count;
uniform uint hovered;  // kNoObject: none
uniform vec3 selected_colour;
uniform vec3 hovered_colour;
uniform float outline_width;

const uint kNoObject = 0xffffffffu;

out vec4 screen;

// By its bits: drivers may take a comparison with NaN as they like, and NVIDIA's does.
bool is_nan(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}

// srgb_from_linear of tracer/render/image.h. NaN becomes 0.
float srgb_from_linear(float linear) {
    if (linear <= 0.0 || is_nan(linear)) return 0.0;
    if (linear <= 0.0031308) return 12.92 * linear;
    return min(1.055 * pow(linear, 1.0 / 2.4) - 0.055, 1.0);
}

// The texel shown at a pixel of the view (the frame may be coarser than the view).
ivec2 texel_at(vec2 pixel) {
    if (block > 0) {
        int row = int(view_size.y) - 1 - int(floor(pixel.y));
        ivec2 texel = ivec2(int(floor(pixel.x)) / block, frame_size.y - 1 - row / block);
        return clamp(texel, ivec2(0), frame_size - 1);
    }
    return clamp(ivec2(floor(pixel * vec2(frame_size) / view_size)), ivec2(0), frame_size - 1);
}

#ifdef OUTLINES
uint object_at(vec2 pixel) {
    return texelFetch(object, texel_at(pixel), 0).r;
}

bool is_selected(uint id) {
    int low = 0;
    int high = selected_count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (texelFetch(selected, middle).r < id) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < selected_count && texelFetch(selected, low).r == id;
}

// The object at a neighbour. Beyond the view's edge that is the last one before it, which is no
// farther away.
uint neighbour(vec2 pixel, int x, int y) {
    return object_at(clamp(pixel + vec2(x, y), vec2(0.5), view_size - 0.5));
}

// Half the length of a row of the disc of neighbours.
int half_row(int y) {
    return int(sqrt(outline_width * outline_width - float(y * y)));
}

// Whether all neighbours show the same object. A loop of its own, since most pixels go no farther.
bool uniform_around(vec2 pixel, uint here) {
    int reach = int(outline_width);
    bool same = true;
    for (int y = -reach; y <= reach; ++y) {
        int row = half_row(y);
        for (int x = -row; x <= row; ++x) same = same && neighbour(pixel, x, y) == here;
    }
    return same;
}

// 2 next to a selected object, 1 next to the hovered one, else 0.
int outline(vec2 pixel) {
    uint here = object_at(pixel);
    if (uniform_around(pixel, here)) return 0;
    int reach = int(outline_width);
    int found = 0;
    for (int y = -reach; y <= reach && found < 2; ++y) {
        int row = half_row(y);
        for (int x = -row; x <= row && found < 2; ++x) {
            uint id = neighbour(pixel, x, y);
            if (id == here || id == kNoObject) continue;
            if (id == hovered) found = 1;
            if (is_selected(id)) found = 2;
        }
    }
    return found;
}
#endif

void main() {
    vec2 pixel = gl_FragCoord.xy - view_origin;
    vec3 linear = texelFetch(colour, texel_at(pixel), 0).rgb;
    screen = vec4(srgb_from_linear(linear.r), srgb_from_linear(linear.g),
                  srgb_from_linear(linear.b), 1.0);
#ifdef OUTLINES
    int mark = outline(pixel);
    if (mark == 2) screen.rgb = selected_colour;
    if (mark == 1) screen.rgb = hovered_colour;
#endif
}
