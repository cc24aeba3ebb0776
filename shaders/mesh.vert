// A mesh's vertices, relative to the eye before anything is rotated or scaled.
#include "view.glsl"

layout(location = 0) in vec3 position;

uniform mat3 clip_from_object;
uniform vec3 eye_high;  // the eye in object space is eye_high + eye_low
uniform vec3 eye_low;

void main() {
    gl_Position = clip_position(clip_from_object * ((position - eye_high) - eye_low));
}
