#include "tracer/io/scene_values.h"

#include "tracer/io/scene_numbers.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace raypick {

namespace {

constexpr NumberRule kFovy{0.0, 180.0, false, "a number between 0 and 180 (degrees)"};
constexpr NumberRule kConeAngle{0.0, 90.0, true, "a number from 0 to 90 (degrees)"};
constexpr NumberRule kSamples{1.0, 64.0, true, "a whole number from 1 to 64"};

// The keys of a light of some type: the common ones and its own.
Keys light_keys(std::initializer_list<std::string_view> own) {
    Keys keys{"type", "name", "colour"};
    keys.insert(keys.end(), own);
    return keys;
}

template <typename LightKind>
void read_common_of_light(const JsonValue& value, LightKind& light) {
    light.name = "light";
    if_present(value, "name", [&](const JsonValue& name) { light.name = name.text_or_empty(); });
    if_present(value, "colour", [&](const JsonValue& c) { light.colour = read_colour(c); });
}

double read_fall_off(const JsonValue& value) {
    constexpr NumberRule kFallOff{kLeastAttenuation, kLargestCoordinate, true,
                                  "0 or a number from 1e-18 to 1e18"};
    return value.equals(0) ? 0.0 : value.number(kFallOff);
}

void read_attenuation(const JsonValue& light, Attenuation& attenuation) {
    if_present(light, "attenuation", [&](const JsonValue& value) {
        const std::vector<JsonValue> abc =
            value.elements(3, "three numbers [constant, linear, quadratic]");
        attenuation = {read_fall_off(abc[0]), read_fall_off(abc[1]), read_fall_off(abc[2])};
        if (attenuation == Attenuation{0.0, 0.0, 0.0}) {
            value.fail("must not be [0, 0, 0]: the light would be infinitely bright");
        }
    });
}

void read_samples(const JsonValue& light, int& samples) {
    if_present(light, "samples", [&](const JsonValue& value) {
        samples = static_cast<int>(value.whole_number(kSamples));
    });
}

Light read_point_light(const JsonValue& value) {
    value.only_keys("a point light", light_keys({"position", "attenuation"}));
    PointLight light;
    read_common_of_light(value, light);
    light.position = read_point(value.need("position"));
    read_attenuation(value, light.attenuation);
    return light;
}

Light read_directional_light(const JsonValue& value) {
    value.only_keys("a directional light", light_keys({"direction"}));
    DirectionalLight light;
    read_common_of_light(value, light);
    light.direction = read_direction(value.need("direction"));
    return light;
}

Light read_spot_light(const JsonValue& value) {
    value.only_keys("a spot light", light_keys({"position", "direction", "attenuation",
                                                "inner_degrees", "outer_degrees"}));
    SpotLight light;
    read_common_of_light(value, light);
    light.position = read_point(value.need("position"));
    light.direction = read_direction(value.need("direction"));
    read_attenuation(value, light.attenuation);
    if_present(value, "outer_degrees",
               [&](const JsonValue& angle) { light.outer_degrees = angle.number(kConeAngle); });
    light.inner_degrees = std::min(light.inner_degrees, light.outer_degrees);
    if_present(value, "inner_degrees", [&](const JsonValue& angle) {
        light.inner_degrees = angle.number(kConeAngle);
        if (light.inner_degrees > light.outer_degrees) {
            angle.fail(fmt::format("must not be more than outer_degrees, which is {}",
                                   light.outer_degrees));
        }
    });
    return light;
}

Light read_sphere_light(const JsonValue& value) {
    value.only_keys("a sphere light", light_keys({"centre", "radius", "attenuation", "samples"}));
    SphereLight light;
    read_common_of_light(value, light);
    light.centre = read_point(value.need("centre"));
    light.radius = value.need("radius").number(kPositive);
    read_attenuation(value, light.attenuation);
    read_samples(value, light.samples);
    return light;
}

Light read_rectangle_light(const JsonValue& value) {
    value.only_keys("a rectangle light",
                    light_keys({"corner", "edge_u", "edge_v", "attenuation", "samples"}));
    RectangleLight light;
    read_common_of_light(value, light);
    light.corner = read_point(value.need("corner"));
    light.edge_u = read_direction(value.need("edge_u"));
    light.edge_v = read_direction(value.need("edge_v"));
    read_attenuation(value, light.attenuation);
    read_samples(value, light.samples);
    return light;
}

Transform read_rotation(const JsonValue& value) {
    value.only_keys("a rotation", Keys{"axis", "degrees"});
    return rotate(value.need("degrees").number(kCoordinate), read_direction(value.need("axis")));
}

Transform read_scale(const JsonValue& value) {
    const glm::dvec3 factors =
        value.is_number() ? glm::dvec3(value.number(kCoordinate)) : read_point(value);
    const Transform transform = scale(factors);
    if (!inverse(transform)) value.fail("must not be 0: it would flatten the object");
    return transform;
}

// Three rows of four numbers, or four of which the last is 0 0 0 1.
Transform read_matrix(const JsonValue& value) {
    const std::vector<JsonValue> rows = value.elements();
    if (rows.size() != 3 && rows.size() != 4) value.refuse("3 or 4 rows of 4 numbers");
    glm::dmat4 columns(1.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const std::vector<JsonValue> row = rows[r].elements(4, "a row of 4 numbers");
        for (std::size_t c = 0; c < 4; ++c) {
            columns[static_cast<int>(c)][static_cast<int>(r)] = row[c].number(kCoordinate);
        }
    }
    if (glm::transpose(columns)[3] != glm::dvec4(0.0, 0.0, 0.0, 1.0)) {
        rows[3].fail("the last row must be [0, 0, 0, 1]: only affine maps place objects");
    }
    const Transform transform = from_matrix(columns);
    if (!inverse(transform)) value.fail("is singular: it would flatten the object");
    return transform;
}

}  // namespace

NamedCamera read_camera(const JsonValue& value, std::string default_name) {
    value.only_keys("a camera",
                    Keys{"name", "eye", "at", "up", "fovy", "projection", "height", "near"});
    NamedCamera named{std::move(default_name), {}};
    Camera& camera = named.camera;
    if_present(value, "name", [&](const JsonValue& name) { named.name = name.text_or_empty(); });
    camera.eye = read_point(value.need("eye"));
    camera.at = read_point(value.need("at"));
    if (camera.eye == camera.at) value.need("at").fail("must not be the same point as eye");
    if_present(value, "up", [&](const JsonValue& up) { camera.up = read_direction(up); });
    if_present(value, "fovy", [&](const JsonValue& fovy) { camera.fovy = fovy.number(kFovy); });
    if_present(value, "projection", [&](const JsonValue& word) {
        camera.projection = read_word<Projection>(word, {"perspective", "orthographic"});
    });
    if_present(value, "height", [&](const JsonValue& h) { camera.height = h.number(kPositive); });
    if_present(value, "near", [&](const JsonValue& near) { camera.near = near.number(kPositive); });
    return named;
}

Light read_light(const JsonValue& value) {
    const std::string type =
        value.need("type").one_of(Keys{"point", "directional", "spot", "sphere", "rectangle"});
    if (type == "point") return read_point_light(value);
    if (type == "directional") return read_directional_light(value);
    if (type == "spot") return read_spot_light(value);
    if (type == "sphere") return read_sphere_light(value);
    return read_rectangle_light(value);
}

Transform read_transform(const JsonValue& object) {
    if (const std::optional<JsonValue> matrix = object.find("matrix")) {
        if (object.find("translate") || object.find("rotate") || object.find("scale")) {
            matrix->fail("give either matrix or translate, rotate and scale");
        }
        return read_matrix(*matrix);
    }
    Transform transform;
    if_present(object, "translate",
               [&](const JsonValue& offset) { transform = translate(read_point(offset)); });
    if_present(object, "rotate",
               [&](const JsonValue& rotation) { transform = transform * read_rotation(rotation); });
    if_present(object, "scale",
               [&](const JsonValue& factors) { transform = transform * read_scale(factors); });
    return transform;
}

}  // namespace raypick
