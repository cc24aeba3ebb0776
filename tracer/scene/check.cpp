#include "tracer/error.h"
#include "tracer/scene/scene.h"

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <cmath>
#include <string>
#include <string_view>

namespace raypick {

namespace {

// What is being checked, for the message: `object "ball"`.
std::string describe(std::string_view kind, std::string_view name) {
    return fmt::format("{} \"{}\"", kind, name);
}

[[noreturn]] void complain(const std::string& what, std::string_view key, std::string_view rule,
                           double value) {
    throw Error(fmt::format("{}: {} must be {}, not {}", what, key, rule, value));
}

void check_finite(const std::string& what, std::string_view key, double value) {
    if (!std::isfinite(value)) complain(what, key, "a finite number", value);
}

void check_finite(const std::string& what, std::string_view key, const glm::dvec3& v) {
    check_finite(what, key, v.x);
    check_finite(what, key, v.y);
    check_finite(what, key, v.z);
}

void check_direction(const std::string& what, std::string_view key, const glm::dvec3& v) {
    check_finite(what, key, v);
    if (v == glm::dvec3(0.0)) {
        throw Error(fmt::format("{}: {} must not be zero: it gives a direction", what, key));
    }
}

void check_shape(const Scene&, const std::string& what, const Sphere& sphere) {
    check_finite(what, "centre", sphere.centre);
    check_finite(what, "radius", sphere.radius);
    if (!(sphere.radius > 0.0)) complain(what, "radius", "positive", sphere.radius);
}

void check_shape(const Scene&, const std::string& what, const Plane& plane) {
    check_direction(what, "normal", plane.normal);
    check_finite(what, "d", plane.d);
}

void check_shape(const Scene&, const std::string& what, const Triangle& triangle) {
    check_finite(what, "a", triangle.a);
    check_finite(what, "b", triangle.b);
    check_finite(what, "c", triangle.c);
}

void check_shape(const Scene&, const std::string& what, const Box& box) {
    check_finite(what, "min", box.min);
    check_finite(what, "max", box.max);
    for (int axis = 0; axis < 3; ++axis) {
        if (box.min[axis] > box.max[axis]) {
            throw Error(fmt::format("{}: min must not exceed max, but {} > {} on the {} axis", what,
                                    box.min[axis], box.max[axis], "xyz"[axis]));
        }
    }
}

void check_shape(const Scene& scene, const std::string& what, const MeshInstance& instance) {
    if (instance.mesh >= scene.meshes.size()) {
        throw Error(fmt::format("{}: mesh {} does not exist: the scene has {}", what, instance.mesh,
                                scene.meshes.size()));
    }
}

void check_material_id(const Scene& scene, const std::string& what, MaterialId id) {
    if (id == kNoMaterial || id < scene.materials.size()) return;
    throw Error(fmt::format("{}: material {} does not exist: the scene has {}", what, id,
                            scene.materials.size()));
}

void check_object(const Scene& scene, const Object& object) {
    const std::string what = describe("object", object.name);
    std::visit([&](const auto& shape) { check_shape(scene, what, shape); }, object.shape);
    const Transform& transform = object.world_from_object;
    check_finite(what, "transform", transform.translation);
    for (int column = 0; column < 3; ++column) {
        check_finite(what, "transform", transform.linear[column]);
    }
    if (!inverse(transform)) {
        throw Error(what + ": transform is singular: it flattens the object");
    }
    check_material_id(scene, what, object.material);
}

void check_material(const Material& material) {
    const std::string what = describe("material", material.name);
    check_finite(what, "ambient", material.ambient);
    check_finite(what, "diffuse", material.diffuse);
    check_finite(what, "specular", material.specular);
    check_finite(what, "shininess", material.shininess);
    check_finite(what, "emissive", material.emissive);
    check_finite(what, "reflect", material.reflect);
    check_finite(what, "transmit", material.transmit);
    check_finite(what, "ior", material.ior);
    if (material.shininess < 0.0f) complain(what, "shininess", "0 or more", material.shininess);
    if (!(material.ior > 0.0f)) complain(what, "ior", "positive", material.ior);
}

void check_light(const PointLight& light) {
    const std::string what = describe("light", light.name);
    check_finite(what, "position", light.position);
    check_finite(what, "colour", light.colour);
}

void check_light(const DirectionalLight& light) {
    const std::string what = describe("light", light.name);
    check_direction(what, "direction", light.direction);
    check_finite(what, "colour", light.colour);
}

void check_named_camera(const NamedCamera& named) {
    try {
        check_camera(named.camera);
    } catch (const Error& error) {
        throw Error(describe("camera", named.name) + ": " + error.what());
    }
}

void check_ids(const Scene& scene) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const bool ascending = i == 0 || scene.objects[i - 1].id < object.id;
        if (ascending && object.id < scene.next_object_id) continue;
        throw Error(fmt::format("{}: id {} is out of order: use add_object",
                                describe("object", object.name), object.id));
    }
}

}  // namespace

void check_scene(const Scene& scene) {
    check_ids(scene);
    for (const Mesh& mesh : scene.meshes) {
        check_mesh(mesh);
        for (const Part& part : mesh.parts) {
            check_material_id(scene, describe("mesh", mesh.name), part.material);
        }
    }
    for (const Object& object : scene.objects)
        check_object(scene, object);
    for (const Material& material : scene.materials)
        check_material(material);
    for (const Light& light : scene.lights) {
        std::visit([](const auto& kind) { check_light(kind); }, light);
    }
    for (const NamedCamera& camera : scene.cameras)
        check_named_camera(camera);
    check_finite("the scene", "origin", scene.origin);
    check_finite("the scene", "background", scene.background);
    check_finite("the scene", "ambient", scene.ambient);
}

}  // namespace raypick
