#include "viewer/cli/commands.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/open_scene.h"
#include "viewer/cli/scene_report.h"
#include "viewer/cli/standard_output.h"

#include <fmt/format.h>

namespace raypick {
namespace {

Json material_json(const Material& material) {
    return {{"name", material.name},
            {"ambient", vector_json(material.ambient)},
            {"diffuse", vector_json(material.diffuse)},
            {"specular", vector_json(material.specular)},
            {"shininess", shortest_decimal(material.shininess)},
            {"emissive", vector_json(material.emissive)},
            {"reflect", vector_json(material.reflect)},
            {"transmit", vector_json(material.transmit)},
            {"ior", shortest_decimal(material.ior)}};
}

Json position_json(const Scene& scene, const glm::dvec3& position) {
    return vector_json(scene.origin + position);
}

Json attenuation_json(const Attenuation& a) {
    return {a.constant, a.linear, a.quadratic};
}

// What lights of each kind have beside name and colour, in file coordinates.
struct LightJson {
    const Scene& scene;

    Json operator()(const PointLight& light) const {
        return {{"type", "point"},
                {"position", position_json(scene, light.position)},
                {"attenuation", attenuation_json(light.attenuation)}};
    }
    Json operator()(const DirectionalLight& light) const {
        return {{"type", "directional"}, {"direction", vector_json(light.direction)}};
    }
    Json operator()(const SpotLight& light) const {
        return {{"type", "spot"},
                {"position", position_json(scene, light.position)},
                {"direction", vector_json(light.direction)},
                {"attenuation", attenuation_json(light.attenuation)},
                {"inner_degrees", light.inner_degrees},
                {"outer_degrees", light.outer_degrees}};
    }
    Json operator()(const SphereLight& light) const {
        return {{"type", "sphere"},
                {"centre", position_json(scene, light.centre)},
                {"radius", light.radius},
                {"attenuation", attenuation_json(light.attenuation)},
                {"samples", light.samples}};
    }
    Json operator()(const RectangleLight& light) const {
        return {{"type", "rectangle"},
                {"corner", position_json(scene, light.corner)},
                {"edge_u", vector_json(light.edge_u)},
                {"edge_v", vector_json(light.edge_v)},
                {"attenuation", attenuation_json(light.attenuation)},
                {"samples", light.samples}};
    }
};

Json light_json(const Scene& scene, const Light& light) {
    Json json = std::visit(LightJson{scene}, light);
    std::visit(
        [&json](const auto& kind) {
            json["name"] = kind.name;
            json["colour"] = vector_json(kind.colour);
        },
        light);
    return json;
}

Json camera_json(const Scene& scene, const NamedCamera& named) {
    return {{"name", named.name},
            {"eye", vector_json(scene.origin + named.camera.eye)},
            {"at", vector_json(scene.origin + named.camera.at)},
            {"up", vector_json(named.camera.up)},
            {"fovy", named.camera.fovy}};
}

struct ShapeName {
    const char* operator()(const Sphere&) const { return "sphere"; }
    const char* operator()(const Plane&) const { return "plane"; }
    const char* operator()(const Triangle&) const { return "triangle"; }
    const char* operator()(const Box&) const { return "box"; }
    const char* operator()(const MeshInstance&) const { return "mesh"; }
    const char* operator()(const Disk&) const { return "disk"; }
    const char* operator()(const Rectangle&) const { return "rectangle"; }
    const char* operator()(const Cone&) const { return "cone"; }
    const char* operator()(const Torus&) const { return "torus"; }
    const char* operator()(const SphereSetInstance&) const { return "spheres"; }
    const char* operator()(const ConeSetInstance&) const { return "cones"; }
};

std::string material_name(const Scene& scene, MaterialId id) {
    return id == kNoMaterial ? "" : material(scene, id).name;
}

std::vector<Part> stored_parts(const Scene& scene, const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshInstance>(&shape)) return scene.meshes[mesh->mesh].parts;
    if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
        return scene.sphere_sets[spheres->set].parts;
    }
    if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
        return scene.cone_sets[cones->set].parts;
    }
    return {};
}

// A shape that has no parts is one.
Json parts_json(const Scene& scene, const Object& object) {
    std::vector<Part> parts = stored_parts(scene, object.shape);
    if (parts.empty()) parts.push_back({0, primitive_count(scene, object), kNoMaterial});
    Json json = Json::array();
    for (const Part& part : parts) {
        const MaterialId id = object.material != kNoMaterial ? object.material : part.material;
        json.push_back(
            {{"first", part.first}, {"count", part.count}, {"material", material_name(scene, id)}});
    }
    return json;
}

Json object_json(const Scene& scene, const Object& object) {
    return {{"id", object.id},
            {"name", object.name},
            {"path", object.path},
            {"shape", std::visit(ShapeName{}, object.shape)},
            {"primitives", primitive_count(scene, object)},
            {"bounds", extent_json(file_extent(scene, object))},
            {"parts", parts_json(scene, object)}};
}

template <typename Values, typename ToJson>
Json array_json(const Values& values, const ToJson& to_json) {
    Json json = Json::array();
    for (const auto& value : values)
        json.push_back(to_json(value));
    return json;
}

Json info_json(const InfoCommand& command, const OpenedScene& opened, const BuiltAccel& built) {
    const Scene& scene = *opened.scene;
    const AccelStats stats = built.accel->stats();
    Json json;
    json["file"] = command.scene.file.string();
    add_counts(json, scene);
    json["bounds"] = extent_json(file_extent(scene));
    json["origin"] = vector_json(scene.origin);
    json["materials"] = array_json(scene.materials, material_json);
    json["lights"] =
        array_json(scene.lights, [&](const Light& light) { return light_json(scene, light); });
    json["cameras"] = array_json(
        scene.cameras, [&](const NamedCamera& camera) { return camera_json(scene, camera); });
    json["seconds"] = {{"load", opened.load_seconds}, {"build", built.build_seconds}};
    json["memory_bytes"] = {
        {"meshes", mesh_bytes(scene)}, {"accel", stats.bytes}, {"peak", peak_memory_bytes()}};
    json["accel_nodes"] = stats.nodes;
    json["warnings"] = opened.warnings;
    if (command.objects) {
        json["object_list"] = array_json(
            scene.objects, [&](const Object& object) { return object_json(scene, object); });
    }
    return json;
}

// "1234567" as "1,234,567".
std::string grouped(std::uint64_t number) {
    std::string digits = fmt::format("{}", number);
    for (std::size_t i = digits.size(); i > 3; i -= 3)
        digits.insert(i - 3, ",");
    return digits;
}

std::string megabytes(std::uint64_t bytes) {
    return fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes));
}

// What came from a file, made safe for a terminal.
std::string printable(std::string text) {
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) c = '?';
    }
    return text;
}

std::string extent_text(const std::optional<ObjectExtent>& extent) {
    if (!extent) return "none";
    const glm::dvec3& min = extent->min;
    const glm::dvec3& max = extent->max;
    return fmt::format("({:.9g}, {:.9g}, {:.9g}) to ({:.9g}, {:.9g}, {:.9g})", min.x, min.y, min.z,
                       max.x, max.y, max.z);
}

// At most this many names in one row of the table.
constexpr std::size_t kMostNames = 8;

std::string counted_names(const std::vector<std::string>& names) {
    std::string text = grouped(names.size());
    for (std::size_t i = 0; i < names.size() && i < kMostNames; ++i) {
        text += (i == 0 ? ": " : ", ") + (names[i].empty() ? "(unnamed)" : printable(names[i]));
    }
    if (names.size() > kMostNames) text += ", ...";
    return text;
}

template <typename Values, typename NameOf>
std::string counted_names_of(const Values& values, const NameOf& name_of) {
    std::vector<std::string> names;
    names.reserve(values.size());
    for (const auto& value : values)
        names.push_back(name_of(value));
    return counted_names(names);
}

std::string light_name(const Light& light) {
    return std::visit([](const auto& l) { return l.name; }, light);
}

std::string row(std::string_view label, const std::string& value) {
    return fmt::format("{:<12}{}\n", label, value);
}

std::string summary_text(const InfoCommand& command, const OpenedScene& opened,
                         const BuiltAccel& built) {
    const Scene& scene = *opened.scene;
    const SceneCounts counts = count(scene);
    const AccelStats stats = built.accel->stats();
    std::string text = row("file", printable(command.scene.file.string()));
    text += row("objects", grouped(scene.objects.size()));
    text += row("triangles", grouped(counts.triangles) + " placed, " +
                                 grouped(counts.unique_triangles) + " stored");
    text += row("primitives", grouped(counts.primitives));
    text += row("materials",
                counted_names_of(scene.materials, [](const Material& m) { return m.name; }));
    text += row("lights", counted_names_of(scene.lights, light_name));
    text += row("cameras",
                counted_names_of(scene.cameras, [](const NamedCamera& c) { return c.name; }));
    text += row("bounds", extent_text(file_extent(scene)));
    text += row("time", fmt::format("load {:.3f} s, build {:.3f} s", opened.load_seconds,
                                    built.build_seconds));
    text += row("memory", fmt::format("meshes {}, tree {}, peak {}", megabytes(mesh_bytes(scene)),
                                      megabytes(stats.bytes), megabytes(peak_memory_bytes())));
    return text;
}

std::string object_text(const Scene& scene, const Object& object) {
    std::string text =
        fmt::format("{:>6}  {:<28} {:<9} {:>10}  {:<28} {}\n", object.id, printable(object.name),
                    std::visit(ShapeName{}, object.shape), grouped(primitive_count(scene, object)),
                    printable(object.path), extent_text(file_extent(scene, object)));
    for (const Json& part : parts_json(scene, object)) {
        const std::string name = part["material"];
        text += fmt::format("{:>48}{:>10}  material {}\n", "",
                            grouped(part["count"].get<std::uint64_t>()),
                            name.empty() ? "(none)" : printable(name));
    }
    return text;
}

std::string objects_text(const Scene& scene) {
    std::string text = fmt::format("\n{:>6}  {:<28} {:<9} {:>10}  {:<28} {}\n", "id", "name",
                                   "shape", "primitives", "path", "bounds");
    for (const Object& object : scene.objects)
        text += object_text(scene, object);
    return text;
}

}  // namespace

int run_info(const InfoCommand& command) {
    const OpenedScene opened = open_scene(command.scene);
    const BuiltAccel built = build_timed(opened);
    if (command.scene.verbose) print_report(built);
    StandardOutput output;
    if (command.json) {
        output.write(dump(info_json(command, opened, built)) + "\n");
    } else {
        output.write(summary_text(command, opened, built));
        if (command.objects) output.write(objects_text(*opened.scene));
    }
    output.flush();
    return kExitOk;
}

}  // namespace raypick
