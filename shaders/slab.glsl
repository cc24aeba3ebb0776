// The part of a ray between two parallel planes at `low` and `high` along its way, where it runs at
// speed `d`. A ray along them is between them all the way or never.
vec2 between(float low, float high, float d) {
    if (d == 0.0) return low <= 0.0 && high >= 0.0 ? vec2(-3e38, 3e38) : vec2(3e38, -3e38);
    float a = low / d;
    float b = high / d;
    return vec2(min(a, b), max(a, b));
}
