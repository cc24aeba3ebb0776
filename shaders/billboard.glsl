// Rectangles of the image that hold all pixels whose rays may meet a ball or a truncated cone,
// whatever affine map the object has; six vertices each. They are drawn without an instance each:
// software OpenGL takes far longer for a million instances than for their vertices.
//
// A linear function f of position takes values within r |f| of that at the centre on a ball, and
// within r |f - (f.a) a| on a disk across the unit vector a. Image coordinates are quotients of two
// such functions. Source for the idea: Sigg, Weyrich, Botsch, Gross, "GPU-Based Ray-Casting of
// Quadratic Surfaces", 2006.
#include "view.glsl"

uniform mat3 clip_from_object;  // clip x, clip y, distance along the view

// A ball (axis 0) or a disk across its axis, relative to the eye in object space.
struct Round {
    vec3 centre;
    float radius;
    vec3 axis;
};

float reach(vec3 f, Round body) {
    return body.radius * length(f - dot(f, body.axis) * body.axis);
}

vec2 range(vec3 f, Round body) {
    float middle = dot(f, body.centre);
    float half_width = reach(f, body);
    return vec2(middle - half_width, middle + half_width);
}

vec2 united(vec2 a, vec2 b) {
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// Of f over the distance along the view, for a body all of which is in front of the eye.
vec2 quotient_range(vec3 f, vec3 view, Round body) {
    float distance = dot(view, body.centre);
    float middle = dot(f, body.centre) / distance;
    float half_width = reach(f - middle * view, body) / (distance - reach(view, body));
    return vec2(middle - half_width, middle + half_width);
}

// The same for what of the hull of both is beyond the near plane.
vec2 image_range(vec3 f, vec3 view, Round a, Round b) {
    vec2 values = united(range(f, a), range(f, b));
    if (is_orthographic()) return values;
    vec2 distances = united(range(view, a), range(view, b));
    vec2 between = vec2(max(distances.x, back.w), distances.y);
    vec2 coarse = vec2(values.x / (values.x > 0.0 ? between.y : between.x),
                       values.y / (values.y > 0.0 ? between.x : between.y));
    // Where the plane of the eye is near, the quotients' own bounds are loose or wrong.
    if (!(distances.x > 0.1 * distances.y)) return coarse;
    vec2 fine = united(quotient_range(f, view, a), quotient_range(f, view, b));
    return vec2(max(coarse.x, fine.x), min(coarse.y, fine.y));
}

// This vertex of the rectangle around the hull of two bodies. Its sides run along the line between
// their centres, so that slim cones get slim ones.
vec4 billboard_position(Round a, Round b) {
    mat3 rows = transpose(clip_from_object);
    vec3 view = rows[2];
    if (!(max(range(view, a).y, range(view, b).y) > back.w)) return vec4(2.0, 2.0, 2.0, 1.0);
    // In pixels from the middle of the image.
    vec3 right_of = 0.5 * size.x * rows[0];
    vec3 above = 0.5 * size.y * rows[1];
    vec2 along = vec2(1.0, 0.0);
    vec3 way = b.centre - a.centre;
    vec3 middle = 0.5 * (a.centre + b.centre);
    // How the image of the middle moves towards b.
    vec2 motion = vec2(dot(right_of, way), dot(above, way));
    if (!is_orthographic()) {
        motion = motion * dot(view, middle) -
                 vec2(dot(right_of, middle), dot(above, middle)) * dot(view, way);
    }
    float speed = length(motion);
    if (speed > 0.0 && speed < 1e30) along = motion / speed;

    const float kPixels = 0.1;  // more than the rasteriser's grid, usually 1/256 pixel
    float far = size.x + size.y;
    vec2 x = clamp(image_range(along.x * right_of + along.y * above, view, a, b), -far, far);
    vec2 y = clamp(image_range(along.x * above - along.y * right_of, view, a, b), -far, far);
    const int kCorners[6] = int[6](0, 1, 2, 2, 1, 3);
    int corner = kCorners[gl_VertexID % 6];
    float at_x = (corner & 1) != 0 ? x.y + kPixels : x.x - kPixels;
    float at_y = (corner & 2) != 0 ? y.y + kPixels : y.x - kPixels;
    vec2 p = vec2(at_x * along.x - at_y * along.y, at_x * along.y + at_y * along.x);
    return vec4(2.0 * p / size.xy, 0.0, 1.0);
}
