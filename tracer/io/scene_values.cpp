#include "tracer/io/scene_values.h"

#include "tracer/io/mesh_build.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <limits>
#include <optional>
#include <utility>

namespace raypick {

namespace {

using Keys = std::vector<std::string_view>;

// The least number that is still positive as a float.
constexpr double kSmallest = std::numeric_limits<float>::min();

constexpr NumberRule kCoordinate{-kLargestCoordinate, kLargestCoordinate, true,
                                 "a number between -1e18 and 1e18"};
constexpr NumberRule kPositive{kSmallest, kLargestCoordinate, true, "a positive number"};
constexpr NumberRule kNotNegative{0.0, kLargestCoordinate, true, "a number that is 0 or more"};
constexpr NumberRule kFovy{0.0, 180.0, false, "a number between 0 and 180 (degrees)"};

// Calls read(value) if there is such a key.
template <typename Read>
void if_present(const JsonValue& object, std::string_view key, const Read& read) {
    if (const std::optional<JsonValue> value = object.find(key)) read(*value);
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

float read_float(const JsonValue& value, const NumberRule& rule) {
    return static_cast<float>(value.number(rule));
}

template <typename LightKind>
void read_common_of_light(const JsonValue& value, LightKind& light) {
    light.name = "light";
    if_present(value, "name", [&](const JsonValue& name) { light.name = name.text(); });
    if_present(value, "colour", [&](const JsonValue& c) { light.colour = read_colour(c); });
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

// The keys of an object of some type: the common ones and its own.
Keys object_keys(std::initializer_list<std::string_view> own) {
    Keys keys{"type", "name", "material", "translate", "rotate", "scale", "matrix"};
    keys.insert(keys.end(), own);
    return keys;
}

// Unit normals, one a position.
std::vector<glm::vec3> read_normals(const JsonValue& value, std::size_t position_count) {
    std::vector<glm::vec3> normals;
    for (const JsonValue& element :
         value.elements(position_count,
                        fmt::format("an array of {} normals, one a position", position_count))) {
        normals.emplace_back(glm::normalize(read_direction(element)));
    }
    return normals;
}

std::vector<glm::uvec3> read_triangles(const JsonValue& value, std::size_t position_count) {
    if (position_count == 0) value.fail("there are no positions to connect");
    const std::size_t last = position_count - 1;
    const std::string words = fmt::format("the number of a position, 0 to {}", last);
    const NumberRule rule{0.0, static_cast<double>(last), true, words};
    std::vector<glm::uvec3> triangles;
    for (const JsonValue& element : value.elements()) {
        glm::uvec3 triangle{0};
        const std::vector<JsonValue> corners = element.elements(3, "three numbers of positions");
        for (std::size_t i = 0; i < 3; ++i) {
            const double number = corners[i].number(rule);
            const auto index = static_cast<std::uint32_t>(number);
            if (number != index) corners[i].refuse(words);
            triangle[static_cast<int>(i)] = index;
        }
        triangles.push_back(triangle);
    }
    return triangles;
}

}  // namespace

glm::vec3 read_colour(const JsonValue& value) {
    if (value.is_number()) return glm::vec3(read_float(value, kNotNegative));
    const std::vector<JsonValue> rgb =
        value.elements(3, "a colour: [red, green, blue] or one number");
    return {read_float(rgb[0], kNotNegative), read_float(rgb[1], kNotNegative),
            read_float(rgb[2], kNotNegative)};
}

NamedCamera read_camera(const JsonValue& value, std::string default_name) {
    value.only_keys("a camera", Keys{"name", "eye", "at", "up", "fovy"});
    NamedCamera named{std::move(default_name), {}};
    Camera& camera = named.camera;
    if_present(value, "name", [&](const JsonValue& name) { named.name = name.text(); });
    camera.eye = read_point(value.need("eye"));
    camera.at = read_point(value.need("at"));
    if (camera.eye == camera.at) value.need("at").fail("must not be the same point as eye");
    if_present(value, "up", [&](const JsonValue& up) { camera.up = read_direction(up); });
    if_present(value, "fovy", [&](const JsonValue& fovy) { camera.fovy = fovy.number(kFovy); });
    return named;
}

Light read_light(const JsonValue& value) {
    if (value.need("type").one_of(Keys{"point", "directional"}) == "point") {
        value.only_keys("a point light", Keys{"type", "name", "position", "colour"});
        PointLight light;
        read_common_of_light(value, light);
        light.position = read_point(value.need("position"));
        return light;
    }
    value.only_keys("a directional light", Keys{"type", "name", "direction", "colour"});
    DirectionalLight light;
    read_common_of_light(value, light);
    light.direction = read_direction(value.need("direction"));
    return light;
}

Material read_material(const JsonValue& value, std::string name) {
    value.only_keys("a material", Keys{"ambient", "diffuse", "specular", "shininess", "emissive",
                                       "reflect", "transmit", "ior"});
    Material material;
    material.name = std::move(name);
    const auto read_if_present = [&value](std::string_view key, glm::vec3& target) {
        if_present(value, key, [&target](const JsonValue& c) { target = read_colour(c); });
    };
    read_if_present("diffuse", material.diffuse);
    material.ambient = material.diffuse;
    read_if_present("ambient", material.ambient);
    read_if_present("specular", material.specular);
    read_if_present("emissive", material.emissive);
    read_if_present("reflect", material.reflect);
    read_if_present("transmit", material.transmit);
    if_present(value, "shininess", [&](const JsonValue& shininess) {
        material.shininess = read_float(shininess, kNotNegative);
    });
    if_present(value, "ior",
               [&](const JsonValue& ior) { material.ior = read_float(ior, kPositive); });
    return material;
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

Sphere read_sphere(const JsonValue& object) {
    object.only_keys("a sphere", object_keys({"centre", "radius"}));
    Sphere sphere;
    if_present(object, "centre", [&](const JsonValue& c) { sphere.centre = read_point(c); });
    sphere.radius = object.need("radius").number(kPositive);
    return sphere;
}

Plane read_plane(const JsonValue& object) {
    object.only_keys("a plane", object_keys({"normal", "d"}));
    Plane plane;
    plane.normal = read_direction(object.need("normal"));
    if_present(object, "d", [&](const JsonValue& d) { plane.d = d.number(kCoordinate); });
    return plane;
}

Triangle read_triangle(const JsonValue& object) {
    object.only_keys("a triangle", object_keys({"a", "b", "c"}));
    return {read_point(object.need("a")), read_point(object.need("b")),
            read_point(object.need("c"))};
}

Box read_box(const JsonValue& object) {
    object.only_keys("a box", object_keys({"min", "max"}));
    const Box box{read_point(object.need("min")), read_point(object.need("max"))};
    for (int axis = 0; axis < 3; ++axis) {
        if (box.max[axis] < box.min[axis]) {
            object.need("max").fail(
                fmt::format("must not be less than min, but is in {}", "xyz"[axis]));
        }
    }
    return box;
}

void check_mesh_keys(const JsonValue& object) {
    object.only_keys("a mesh", object_keys({"file", "positions", "triangles", "normals"}));
    const std::optional<JsonValue> file = object.find("file");
    if (!file) {
        if (!object.find("positions")) object.fail("give either file or positions and triangles");
        return;
    }
    for (const std::string_view key : {"positions", "triangles", "normals"}) {
        if (const std::optional<JsonValue> array = object.find(key)) {
            array->fail("the mesh comes from a file: give either file or positions and triangles");
        }
    }
}

void check_instance_keys(const JsonValue& object) {
    object.only_keys("an instance", object_keys({"of"}));
}

InlineMesh read_inline_mesh(const JsonValue& object) {
    std::vector<glm::dvec3> points;
    PointBounds bounds;
    for (const JsonValue& element : object.need("positions").elements()) {
        points.push_back(read_point(element));
        bounds.extend(points.back());
    }
    InlineMesh mesh;
    mesh.origin = storage_origin(bounds);
    mesh.data.positions.reserve(points.size());
    for (const glm::dvec3& p : points)
        mesh.data.positions.emplace_back(p - mesh.origin);
    mesh.data.triangles = read_triangles(object.need("triangles"), points.size());
    if_present(object, "normals", [&](const JsonValue& normals) {
        mesh.data.normals = read_normals(normals, points.size());
    });
    return mesh;
}

}  // namespace raypick
