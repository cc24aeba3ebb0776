#include "tracer/io/scene_shapes.h"

#include "tracer/io/scene_numbers.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace raypick {

namespace {

// The keys of an object of some type: the common ones and its own.
Keys object_keys(std::initializer_list<std::string_view> own) {
    Keys keys{"type",     "name",      "path",   "id",    "mask",  "sides",
              "material", "translate", "rotate", "scale", "matrix"};
    keys.insert(keys.end(), own);
    return keys;
}

Shape read_sphere(const JsonValue& object) {
    object.only_keys("a sphere", object_keys({"centre", "radius"}));
    Sphere sphere;
    if_present(object, "centre", [&](const JsonValue& c) { sphere.centre = read_point(c); });
    sphere.radius = object.need("radius").number(kPositive);
    return sphere;
}

Shape read_plane(const JsonValue& object) {
    object.only_keys("a plane", object_keys({"normal", "d"}));
    Plane plane;
    plane.normal = read_direction(object.need("normal"));
    if_present(object, "d", [&](const JsonValue& d) { plane.d = d.number(kCoordinate); });
    return plane;
}

Shape read_triangle(const JsonValue& object) {
    object.only_keys("a triangle", object_keys({"a", "b", "c"}));
    return Triangle{read_point(object.need("a")), read_point(object.need("b")),
                    read_point(object.need("c"))};
}

Shape read_box(const JsonValue& object) {
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

Shape read_disk(const JsonValue& object) {
    object.only_keys("a disk", object_keys({"centre", "normal", "radius", "inner_radius"}));
    Disk disk;
    if_present(object, "centre", [&](const JsonValue& c) { disk.centre = read_point(c); });
    disk.normal = read_direction(object.need("normal"));
    disk.radius = object.need("radius").number(kPositive);
    if_present(object, "inner_radius", [&](const JsonValue& inner) {
        disk.inner_radius = inner.number(kNotNegative);
        if (disk.inner_radius >= disk.radius) {
            inner.fail(fmt::format("must be less than radius, which is {}", disk.radius));
        }
    });
    return disk;
}

Shape read_rectangle(const JsonValue& object) {
    object.only_keys("a rectangle", object_keys({"corner", "edge_u", "edge_v"}));
    const Rectangle rectangle{read_point(object.need("corner")),
                              read_direction(object.need("edge_u")),
                              read_direction(object.need("edge_v"))};
    const glm::dvec3 u = rectangle.edge_u / glm::length(rectangle.edge_u);
    const glm::dvec3 v = rectangle.edge_v / glm::length(rectangle.edge_v);
    if (glm::cross(u, v) == glm::dvec3(0.0)) {
        object.need("edge_v").fail("must not be parallel to edge_u");
    }
    return rectangle;
}

// What cones and cylinders have in common.
Cone read_axis(const JsonValue& object) {
    Cone cone;
    cone.base = read_point(object.need("base"));
    cone.apex = read_point(object.need("apex"));
    if (cone.base == cone.apex) object.need("apex").fail("must not be the same point as base");
    if_present(object, "capped", [&](const JsonValue& capped) { cone.capped = capped.truth(); });
    return cone;
}

Shape read_cone(const JsonValue& object) {
    object.only_keys("a cone",
                     object_keys({"base", "apex", "base_radius", "apex_radius", "capped"}));
    Cone cone = read_axis(object);
    cone.base_radius = object.need("base_radius").number(kNotNegative);
    cone.apex_radius = 0.0;
    if_present(object, "apex_radius",
               [&](const JsonValue& radius) { cone.apex_radius = radius.number(kNotNegative); });
    if (cone.base_radius == 0.0 && cone.apex_radius == 0.0) {
        object.need("base_radius").fail("must not be 0, since apex_radius is");
    }
    return cone;
}

Shape read_cylinder(const JsonValue& object) {
    object.only_keys("a cylinder", object_keys({"base", "apex", "radius", "capped"}));
    Cone cylinder = read_axis(object);
    cylinder.base_radius = object.need("radius").number(kPositive);
    cylinder.apex_radius = cylinder.base_radius;
    return cylinder;
}

Shape read_torus(const JsonValue& object) {
    object.only_keys("a torus", object_keys({"centre", "axis", "major_radius", "minor_radius"}));
    Torus torus;
    if_present(object, "centre", [&](const JsonValue& c) { torus.centre = read_point(c); });
    if_present(object, "axis", [&](const JsonValue& axis) { torus.axis = read_direction(axis); });
    torus.major_radius = object.need("major_radius").number(kPositive);
    const JsonValue minor = object.need("minor_radius");
    torus.minor_radius = minor.number(kPositive);
    if (torus.minor_radius > torus.major_radius) {
        minor.fail(
            fmt::format("must not be more than major_radius, which is {}", torus.major_radius));
    }
    return torus;
}

// Fails if `object` has another key of `keys` beside `given`.
void check_alone(const JsonValue& object, std::string_view given, const Keys& keys) {
    for (const std::string_view key : keys) {
        if (key == given) continue;
        const std::optional<JsonValue> other = object.find(key);
        if (other) other->fail(fmt::format("what this is made of is said by \"{}\"", given));
    }
}

}  // namespace

const Keys kObjectTypes{"sphere",   "plane", "triangle", "box",     "disk",  "rectangle", "cone",
                        "cylinder", "torus", "mesh",     "spheres", "cones", "instance"};

Shape read_shape(const JsonValue& object, std::string_view type) {
    if (type == "sphere") return read_sphere(object);
    if (type == "plane") return read_plane(object);
    if (type == "triangle") return read_triangle(object);
    if (type == "box") return read_box(object);
    if (type == "disk") return read_disk(object);
    if (type == "rectangle") return read_rectangle(object);
    if (type == "cone") return read_cone(object);
    if (type == "cylinder") return read_cylinder(object);
    return read_torus(object);
}

void check_mesh_keys(const JsonValue& object) {
    object.only_keys("a mesh", object_keys({"file", "mesh", "positions", "triangles", "normals",
                                            "uvs", "parts"}));
    const Keys arrays{"positions", "triangles", "normals", "uvs", "parts"};
    if (const std::optional<JsonValue> mesh = object.find("mesh")) {
        check_alone(object, "mesh", {"file", "positions", "triangles", "normals", "uvs", "parts"});
        return;
    }
    if (!object.find("file")) {
        if (!object.find("positions")) object.fail("give either file or positions and triangles");
        return;
    }
    for (const std::string_view key : arrays) {
        if (const std::optional<JsonValue> array = object.find(key)) {
            array->fail("the mesh comes from a file: give either file or positions and triangles");
        }
    }
}

void check_spheres_keys(const JsonValue& object) {
    object.only_keys("a set of spheres", object_keys({"set", "spheres", "parts"}));
    if (object.find("set")) check_alone(object, "set", {"spheres", "parts"});
}

void check_cones_keys(const JsonValue& object) {
    object.only_keys("a set of cones", object_keys({"set", "cones", "capped", "parts"}));
    if (object.find("set")) check_alone(object, "set", {"cones", "capped", "parts"});
}

void check_instance_keys(const JsonValue& object) {
    object.only_keys("an instance", object_keys({"of"}));
}

Sides read_sides(const JsonValue& value) {
    return read_word<Sides>(value, {"both", "front", "back"});
}

}  // namespace raypick
