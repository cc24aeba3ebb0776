#include "tracer/io/scene_numbers.h"

namespace raypick {

float read_float(const JsonValue& value, const NumberRule& rule) {
    return static_cast<float>(value.number(rule));
}

glm::dvec3 read_point(const JsonValue& value) {
    const std::vector<JsonValue> xyz = value.elements(3, "three numbers [x, y, z]");
    return {xyz[0].number(kCoordinate), xyz[1].number(kCoordinate), xyz[2].number(kCoordinate)};
}

glm::dvec3 read_direction(const JsonValue& value) {
    const glm::dvec3 v = read_point(value);
    if (v == glm::dvec3(0.0)) value.fail("must not be [0, 0, 0]: it gives a direction");
    return v;
}

glm::vec3 read_colour(const JsonValue& value, const NumberRule& rule) {
    if (value.is_number()) return glm::vec3(read_float(value, rule));
    const std::vector<JsonValue> rgb =
        value.elements(3, "a colour: [red, green, blue] or one number");
    return {read_float(rgb[0], rule), read_float(rgb[1], rule), read_float(rgb[2], rule)};
}

}  // namespace raypick
