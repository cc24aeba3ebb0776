// Angles about the y axis, as tracer/geometry/axis_frame.h measures them.
#ifdef TEXTURED
// The angle from x over z, as a share of the full turn: in [0, 1].
float turn(float x, float z) {
    float turns = atan(z, x) / kTurn;
    return turns < 0.0 ? turns + 1.0 : turns;
}

// Around the axis: the unit vectors away from it and along the turn. On the axis: those of angle 0.
struct Around {
    vec3 away;
    vec3 along;
    float turn;
};

Around around_y(vec2 xz) {
    float distance = length(xz);
    vec2 away = distance > 0.0 ? xz / distance : vec2(1.0, 0.0);
    return Around(vec3(away.x, 0.0, away.y), vec3(-away.y, 0.0, away.x),
                  distance > 0.0 ? turn(xz.x, xz.y) : 0.0);
}
#endif
