// Angles about an axis, as tracer/geometry/axis_frame.h measures them.
#ifdef TEXTURED
// The angle from x over z, as a share of the full turn: in [0, 1].
float turn(float x, float z) {
    float turns = atan(z, x) / kTurn;
    return turns < 0.0 ? turns + 1.0 : turns;
}

// The unit vectors away from the axis and along the turn, in x and z. On the axis: those of angle 0.
struct Around {
    vec2 away;
    vec2 along;
    float turn;
};

Around around_axis(vec2 xz) {
    float distance = length(xz);
    if (!(distance > 0.0)) return Around(vec2(1.0, 0.0), vec2(0.0, 1.0), 0.0);
    vec2 away = xz / distance;
    return Around(away, vec2(-away.y, away.x), turn(xz.x, xz.y));
}
#endif
