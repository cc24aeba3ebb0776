#include "tracer/io/saved_values.h"

#include "tracer/io/saved_members.h"

#include <array>
#include <bit>
#include <cstdint>

namespace raypick {

namespace {

// The type of a light or a shape, and the members that it has of its own.

void write_attenuation(JsonWriter& json, const Attenuation& a) {
    if (a == Attenuation{}) return;
    json.key("attenuation");
    json.open_array(kOneLine);
    for (const double number : {a.constant, a.linear, a.quadratic})
        json.number(number);
    json.close_array();
}

void write_light(JsonWriter& json, const PointLight& light) {
    write_member(json, "type", "point");
    write_member(json, "position", light.position);
    write_attenuation(json, light.attenuation);
}

void write_light(JsonWriter& json, const DirectionalLight& light) {
    write_member(json, "type", "directional");
    write_member(json, "direction", light.direction);
}

void write_light(JsonWriter& json, const SpotLight& light) {
    write_member(json, "type", "spot");
    write_member(json, "position", light.position);
    write_member(json, "direction", light.direction);
    write_attenuation(json, light.attenuation);
    write_member(json, "inner_degrees", light.inner_degrees);
    write_member(json, "outer_degrees", light.outer_degrees);
}

void write_light(JsonWriter& json, const SphereLight& light) {
    write_member(json, "type", "sphere");
    write_member(json, "centre", light.centre);
    write_member(json, "radius", light.radius);
    write_attenuation(json, light.attenuation);
    write_member(json, "samples", static_cast<double>(light.samples));
}

void write_light(JsonWriter& json, const RectangleLight& light) {
    write_member(json, "type", "rectangle");
    write_member(json, "corner", light.corner);
    write_member(json, "edge_u", light.edge_u);
    write_member(json, "edge_v", light.edge_v);
    write_attenuation(json, light.attenuation);
    write_member(json, "samples", static_cast<double>(light.samples));
}

void write_shape(JsonWriter& json, const Sphere& sphere) {
    write_member(json, "type", "sphere");
    write_member(json, "centre", sphere.centre);
    write_member(json, "radius", sphere.radius);
}

void write_shape(JsonWriter& json, const Plane& plane) {
    write_member(json, "type", "plane");
    write_member(json, "normal", plane.normal);
    write_member(json, "d", plane.d);
}

void write_shape(JsonWriter& json, const Triangle& triangle) {
    write_member(json, "type", "triangle");
    write_member(json, "a", triangle.a);
    write_member(json, "b", triangle.b);
    write_member(json, "c", triangle.c);
}

void write_shape(JsonWriter& json, const Box& box) {
    write_member(json, "type", "box");
    write_member(json, "min", box.min);
    write_member(json, "max", box.max);
}

void write_shape(JsonWriter& json, const Disk& disk) {
    write_member(json, "type", "disk");
    write_member(json, "centre", disk.centre);
    write_member(json, "normal", disk.normal);
    write_member(json, "radius", disk.radius);
    write_member(json, "inner_radius", disk.inner_radius);
}

void write_shape(JsonWriter& json, const Rectangle& rectangle) {
    write_member(json, "type", "rectangle");
    write_member(json, "corner", rectangle.corner);
    write_member(json, "edge_u", rectangle.edge_u);
    write_member(json, "edge_v", rectangle.edge_v);
}

void write_shape(JsonWriter& json, const Cone& cone) {
    write_member(json, "type", "cone");
    write_member(json, "base", cone.base);
    write_member(json, "apex", cone.apex);
    write_member(json, "base_radius", cone.base_radius);
    write_member(json, "apex_radius", cone.apex_radius);
    write_member(json, "capped", cone.capped);
}

void write_shape(JsonWriter& json, const Torus& torus) {
    write_member(json, "type", "torus");
    write_member(json, "centre", torus.centre);
    write_member(json, "axis", torus.axis);
    write_member(json, "major_radius", torus.major_radius);
    write_member(json, "minor_radius", torus.minor_radius);
}

void write_shape(JsonWriter& json, const MeshInstance& instance) {
    write_member(json, "type", "mesh");
    write_member(json, "mesh", instance.mesh);
}

void write_shape(JsonWriter& json, const SphereSetInstance& instance) {
    write_member(json, "type", "spheres");
    write_member(json, "set", instance.set);
}

void write_shape(JsonWriter& json, const ConeSetInstance& instance) {
    write_member(json, "type", "cones");
    write_member(json, "set", instance.set);
}

void write_matrix(JsonWriter& json, const Transform& transform) {
    json.key("matrix");
    json.open_array(kOneLine);
    for (int row = 0; row < 3; ++row) {
        json.open_array();
        for (int column = 0; column < 3; ++column)
            json.number(transform.linear[column][row]);
        json.number(transform.translation[row]);
        json.close_array();
    }
    json.close_array();
}

void write_parts(JsonWriter& json, const std::vector<Part>& parts) {
    if (parts.empty()) return;
    json.key("parts");
    json.open_array();
    for (const Part& part : parts) {
        json.open_object(kOneLine);
        write_member(json, "first", part.first);
        write_member(json, "count", part.count);
        if (part.material != kNoMaterial) write_member(json, "material", part.material);
        json.close_object();
    }
    json.close_array();
}

// Is this the identity, down to the signs of its zeros?
bool is_plain(const Transform& transform) {
    const Transform identity;
    using Bits = std::array<std::uint64_t, sizeof identity / sizeof(double)>;
    return std::bit_cast<Bits>(transform) == std::bit_cast<Bits>(identity);
}

}  // namespace

void write_value(JsonWriter& json, const NamedCamera& named) {
    const Camera& camera = named.camera;
    const Camera defaults;
    json.open_object();
    write_member(json, "name", named.name);
    write_member(json, "eye", camera.eye);
    write_member(json, "at", camera.at);
    write_member(json, "up", camera.up);
    write_member(json, "fovy", camera.fovy);
    if (camera.near != defaults.near) write_member(json, "near", camera.near);
    if (camera.projection == Projection::orthographic) {
        write_member(json, "projection", "orthographic");
    }
    if (camera.height != defaults.height) write_member(json, "height", camera.height);
    json.close_object();
}

void write_value(JsonWriter& json, const Light& light) {
    json.open_object();
    std::visit(
        [&json](const auto& kind) {
            write_member(json, "name", kind.name);
            write_light(json, kind);
            write_member(json, "colour", kind.colour);
        },
        light);
    json.close_object();
}

void write_value(JsonWriter& json, const Mesh& mesh) {
    json.open_object();
    write_member(json, "name", mesh.name);
    write_array<float>(json, "positions", mesh.positions);
    write_array<std::uint32_t>(json, "triangles", mesh.triangles);
    if (!mesh.normals.empty()) write_array<float>(json, "normals", mesh.normals);
    if (!mesh.uvs.empty()) write_array<float>(json, "uvs", mesh.uvs);
    write_parts(json, mesh.parts);
    json.close_object();
}

void write_value(JsonWriter& json, const SphereSet& set) {
    json.open_object();
    write_member(json, "name", set.name);
    write_array<float>(json, "spheres", set.spheres);
    write_parts(json, set.parts);
    json.close_object();
}

void write_value(JsonWriter& json, const ConeSet& set) {
    json.open_object();
    write_member(json, "name", set.name);
    write_array<float>(json, "cones", set.ends);
    write_member(json, "capped", set.capped);
    write_parts(json, set.parts);
    json.close_object();
}

void write_value(JsonWriter& json, const Object& object, ObjectId next_id) {
    json.open_object();
    write_member(json, "name", object.name);
    if (object.path != '/' + object.name) write_member(json, "path", object.path);
    if (object.id != next_id) write_member(json, "id", object.id);
    std::visit([&json](const auto& shape) { write_shape(json, shape); }, object.shape);
    if (!is_plain(object.world_from_object)) write_matrix(json, object.world_from_object);
    if (object.material != kNoMaterial) write_member(json, "material", object.material);
    if (object.mask != Object{}.mask) write_member(json, "mask", object.mask);
    if (object.sides == Sides::front_only) write_member(json, "sides", "front");
    if (object.sides == Sides::back_only) write_member(json, "sides", "back");
    json.close_object();
}

}  // namespace raypick
