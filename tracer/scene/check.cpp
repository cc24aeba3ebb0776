#include "tracer/error.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <span>
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

void check_coordinate(const std::string& what, std::string_view key, const glm::dvec3& v) {
    check_finite(what, key, v);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(v[axis]) <= kLargestCoordinate) continue;
        complain(what, key, fmt::format("between -{0} and {0}", kLargestCoordinate), v[axis]);
    }
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

void check_radius(const std::string& what, std::string_view key, double radius) {
    check_finite(what, key, radius);
    if (!(radius > 0.0)) complain(what, key, "positive", radius);
}

void check_shape(const Scene&, const std::string& what, const Disk& disk) {
    check_finite(what, "centre", disk.centre);
    check_direction(what, "normal", disk.normal);
    check_radius(what, "radius", disk.radius);
    check_finite(what, "inner_radius", disk.inner_radius);
    if (!(disk.inner_radius >= 0.0)) {
        complain(what, "inner_radius", "0 or more", disk.inner_radius);
    }
    if (!(disk.inner_radius < disk.radius)) {
        complain(what, "inner_radius", fmt::format("less than the radius {}", disk.radius),
                 disk.inner_radius);
    }
}

void check_shape(const Scene&, const std::string& what, const Rectangle& rectangle) {
    check_finite(what, "corner", rectangle.corner);
    check_direction(what, "edge_u", rectangle.edge_u);
    check_direction(what, "edge_v", rectangle.edge_v);
    const glm::dvec3 u = glm::normalize(rectangle.edge_u);
    const glm::dvec3 v = glm::normalize(rectangle.edge_v);
    if (!(glm::length(glm::cross(u, v)) > 1e-12)) {
        throw Error(fmt::format("{}: edge_v must not be parallel to edge_u, but {} {} {} is", what,
                                rectangle.edge_v.x, rectangle.edge_v.y, rectangle.edge_v.z));
    }
}

void check_shape(const Scene&, const std::string& what, const Cone& cone) {
    check_finite(what, "base", cone.base);
    check_finite(what, "apex", cone.apex);
    check_finite(what, "base_radius", cone.base_radius);
    check_finite(what, "apex_radius", cone.apex_radius);
    if (!(cone.base_radius >= 0.0)) complain(what, "base_radius", "0 or more", cone.base_radius);
    if (!(cone.apex_radius >= 0.0)) complain(what, "apex_radius", "0 or more", cone.apex_radius);
    if (cone.base_radius == 0.0 && cone.apex_radius == 0.0) {
        throw Error(what + ": base_radius and apex_radius must not both be 0");
    }
    if (cone.base == cone.apex) {
        throw Error(fmt::format("{}: base and apex must not be the same point, {} {} {}", what,
                                cone.base.x, cone.base.y, cone.base.z));
    }
}

void check_shape(const Scene&, const std::string& what, const Torus& torus) {
    check_finite(what, "centre", torus.centre);
    check_direction(what, "axis", torus.axis);
    check_radius(what, "major_radius", torus.major_radius);
    check_radius(what, "minor_radius", torus.minor_radius);
    if (!(torus.minor_radius <= torus.major_radius)) {
        complain(what, "minor_radius",
                 fmt::format("no more than the major_radius {}", torus.major_radius),
                 torus.minor_radius);
    }
}

void check_set_id(const std::string& what, std::string_view kind, SetId id, std::size_t count) {
    if (id < count) return;
    throw Error(fmt::format("{}: {} {} does not exist: the scene has {}", what, kind, id, count));
}

void check_shape(const Scene& scene, const std::string& what, const SphereSetInstance& instance) {
    check_set_id(what, "sphere set", instance.set, scene.sphere_sets.size());
}

void check_shape(const Scene& scene, const std::string& what, const ConeSetInstance& instance) {
    check_set_id(what, "cone set", instance.set, scene.cone_sets.size());
}

void check_material_id(const Scene& scene, const std::string& what, MaterialId id) {
    if (id == kNoMaterial || id < scene.materials.size()) return;
    throw Error(fmt::format("{}: material {} does not exist: the scene has {}", what, id,
                            scene.materials.size()));
}

void check_part_materials(const Scene& scene, const std::string& what,
                          std::span<const Part> parts) {
    for (const Part& part : parts)
        check_material_id(scene, what, part.material);
}

void check_object(const Scene& scene, const Object& object) {
    const std::string what = describe("object", object.name);
    std::visit([&](const auto& shape) { check_shape(scene, what, shape); }, object.shape);
    const Transform& transform = object.world_from_object;
    check_coordinate(what, "transform", transform.translation);
    for (int column = 0; column < 3; ++column) {
        check_coordinate(what, "transform", transform.linear[column]);
    }
    if (!inverse(transform)) {
        throw Error(what + ": transform is singular: it flattens the object");
    }
    check_material_id(scene, what, object.material);
}

void check_not_negative(const std::string& what, std::string_view key, double value) {
    check_finite(what, key, value);
    if (value < 0.0) complain(what, key, "0 or more", value);
}

void check_up_to(const std::string& what, std::string_view key, double value, double most) {
    check_not_negative(what, key, value);
    if (value > most) complain(what, key, fmt::format("{} or less", most), value);
}

void check_up_to(const std::string& what, std::string_view key, const glm::vec3& v, double most) {
    check_up_to(what, key, v.x, most);
    check_up_to(what, key, v.y, most);
    check_up_to(what, key, v.z, most);
}

void check_fraction(const std::string& what, std::string_view key, double value) {
    if (!(value >= 0.0 && value <= 1.0)) complain(what, key, "between 0 and 1", value);
}

void check_map(const Scene& scene, const std::string& what, const TextureMap& map) {
    if (!map) return;
    if (map.texture >= scene.textures.size()) {
        throw Error(fmt::format("{}: texture {} does not exist: the scene has {}", what,
                                map.texture, scene.textures.size()));
    }
    check_coordinate(what, "texture transform", map.u_row);
    check_coordinate(what, "texture transform", map.v_row);
    check_coordinate(what, "texture base and gain", {map.base, map.gain, 0.0});
}

// The most that a map makes of the colour that it multiplies.
glm::vec3 mapped(const glm::vec3& colour, const TextureMap& map) {
    if (!map) return colour;
    return colour * std::max(std::abs(map.base), std::abs(map.base + map.gain));
}

void check_colours(const std::string& what, const Material& m) {
    const auto check = [&](std::string_view key, const glm::vec3& colour, MapSlot slot,
                           double most) {
        check_up_to(what, key, colour, most);
        const std::string with_map = fmt::format("{} times its map", key);
        check_up_to(what, with_map, mapped(colour, m.map(slot)), most);
    };
    const MapSlot ambient = m.map(MapSlot::ambient) ? MapSlot::ambient : MapSlot::diffuse;
    check("ambient", m.ambient, ambient, kMostSurfaceColour);
    check("diffuse", m.diffuse, MapSlot::diffuse, kMostSurfaceColour);
    check("specular", m.specular, MapSlot::specular, kMostSurfaceColour);
    check("emissive", m.emissive, MapSlot::emissive, kMostLight);
    check("reflect", m.reflect, MapSlot::reflect, kMostBounce);
    check("transmit", m.transmit, MapSlot::transmit, kMostBounce);
}

void check_material(const Scene& scene, const Material& material) {
    const std::string what = describe("material", material.name);
    for (const TextureMap& map : material.maps)
        check_map(scene, what, map);
    check_colours(what, material);
    check_up_to(what, "shininess", material.shininess, kMostExponent);
    check_up_to(what, "absorption", material.absorption, kMostAbsorption);
    check_finite(what, "ior", material.ior);
    if (!(material.ior > 0.0f)) complain(what, "ior", "positive", material.ior);
    check_fraction(what, "opacity", material.opacity);
    check_not_negative(what, "alpha_cutoff", material.alpha_cutoff);  // above 1: nothing is there
}

void check_attenuation(const std::string& what, const Attenuation& attenuation) {
    const auto check = [&](std::string_view key, double value) {
        check_not_negative(what, key, value);
        if (value == 0.0 || value >= kLeastAttenuation) return;
        complain(what, key, fmt::format("0 or at least {}", kLeastAttenuation), value);
    };
    check("constant attenuation", attenuation.constant);
    check("linear attenuation", attenuation.linear);
    check("quadratic attenuation", attenuation.quadratic);
    if (attenuation == Attenuation{0.0, 0.0, 0.0}) {
        throw Error(what + ": attenuation must not be all 0: it divides the light");
    }
}

void check_samples(const std::string& what, int samples) {
    if (samples < 1 || samples > 64) complain(what, "samples", "from 1 to 64", samples);
}

void check_light(const PointLight& light) {
    const std::string what = describe("light", light.name);
    check_finite(what, "position", light.position);
    check_up_to(what, "colour", light.colour, kMostLight);
    check_attenuation(what, light.attenuation);
}

void check_light(const DirectionalLight& light) {
    const std::string what = describe("light", light.name);
    check_direction(what, "direction", light.direction);
    check_up_to(what, "colour", light.colour, kMostLight);
}

void check_light(const SpotLight& light) {
    const std::string what = describe("light", light.name);
    check_finite(what, "position", light.position);
    check_direction(what, "direction", light.direction);
    check_up_to(what, "colour", light.colour, kMostLight);
    check_attenuation(what, light.attenuation);
    check_not_negative(what, "inner_degrees", light.inner_degrees);
    if (!(light.outer_degrees >= light.inner_degrees && light.outer_degrees <= 90.0)) {
        complain(what, "outer_degrees", "between inner_degrees and 90", light.outer_degrees);
    }
}

void check_light(const SphereLight& light) {
    const std::string what = describe("light", light.name);
    check_finite(what, "centre", light.centre);
    check_finite(what, "radius", light.radius);
    if (!(light.radius > 0.0)) complain(what, "radius", "positive", light.radius);
    check_up_to(what, "colour", light.colour, kMostLight);
    check_attenuation(what, light.attenuation);
    check_samples(what, light.samples);
}

void check_light(const RectangleLight& light) {
    const std::string what = describe("light", light.name);
    check_finite(what, "corner", light.corner);
    check_direction(what, "edge_u", light.edge_u);
    check_direction(what, "edge_v", light.edge_v);
    check_up_to(what, "colour", light.colour, kMostLight);
    check_attenuation(what, light.attenuation);
    check_samples(what, light.samples);
}

void check_environment(const std::monostate&) {}

void check_environment(const GradientSky& sky) {
    const std::string what = "the environment";
    check_up_to(what, "zenith", sky.zenith, kMostLight);
    check_up_to(what, "horizon", sky.horizon, kMostLight);
    check_up_to(what, "ground", sky.ground, kMostLight);
    check_direction(what, "up", sky.up);
}

void check_environment(const ImageSky& sky) {
    const std::string what = "the environment";
    check_direction(what, "up", sky.up);
    check_direction(what, "forward", sky.forward);
    const glm::dvec3 across = glm::cross(glm::normalize(sky.up), glm::normalize(sky.forward));
    if (!(glm::length(across) > 1e-12)) {
        throw Error(what + ": forward must not be parallel to up");
    }
    check_up_to(what, "scale", sky.scale, kMostLight);
}

void check_texture(const Texture& texture) {
    const auto* checker = std::get_if<Checker>(&texture.source);
    if (checker == nullptr) return;
    const std::string what = describe("texture", texture.name);
    for (int channel = 0; channel < 4; ++channel) {
        check_fraction(what, "even", checker->even[channel]);
        check_fraction(what, "odd", checker->odd[channel]);
    }
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
        check_part_materials(scene, describe("mesh", mesh.name), mesh.parts);
    }
    for (const SphereSet& set : scene.sphere_sets) {
        check_set(set);
        check_part_materials(scene, describe("sphere set", set.name), set.parts);
    }
    for (const ConeSet& set : scene.cone_sets) {
        check_set(set);
        check_part_materials(scene, describe("cone set", set.name), set.parts);
    }
    for (const Object& object : scene.objects)
        check_object(scene, object);
    for (const Material& material : scene.materials)
        check_material(scene, material);
    for (const Light& light : scene.lights) {
        std::visit([](const auto& kind) { check_light(kind); }, light);
    }
    for (const NamedCamera& camera : scene.cameras)
        check_named_camera(camera);
    check_finite("the scene", "origin", scene.origin);
    check_up_to("the scene", "background", scene.background, kMostLight);
    check_up_to("the scene", "ambient", scene.ambient, kMostLight);
    for (const Texture& texture : scene.textures)
        check_texture(texture);
    std::visit([](const auto& kind) { check_environment(kind); }, scene.environment);
}

}  // namespace raypick
