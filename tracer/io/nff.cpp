// NFF, the Neutral File Format of Haines' Standard Procedural Databases.
//
// What shows the same sides is one object with many primitives: a sphere set, a cone set, a mesh.
#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/formats.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/nff_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

namespace {

// Of what NFF materials reflect of it, which is their whole colour.
constexpr float kAmbient = 0.1f;

PointBounds bounds_of(const NffContent& content) {
    PointBounds bounds;
    for (std::size_t sides = 0; sides < kSideKinds; ++sides) {
        for (const glm::dvec4& sphere : content.spheres[sides].spheres) {
            bounds.extend(glm::dvec3(sphere) - sphere.w);
            bounds.extend(glm::dvec3(sphere) + sphere.w);
        }
        for (const glm::dvec4& end : content.cones[sides].ends) {
            bounds.extend(glm::dvec3(end) - end.w);
            bounds.extend(glm::dvec3(end) + end.w);
        }
        for (const glm::dvec3& p : content.polygons[sides].positions)
            bounds.extend(p);
        for (const glm::dvec3& p : content.patches[sides].positions)
            bounds.extend(p);
    }
    return bounds;
}

// Turns the file's content into objects whose floats are relative to one origin.
class NffScene {
public:
    NffScene(Scene& scene, const glm::dvec3& origin) : scene_(scene), origin_(origin) {}

    void add(const NffSpheres& group, Sides sides) {
        if (group.spheres.empty()) return;
        if (group.spheres.size() == 1) {
            const glm::dvec4& sphere = group.spheres[0];
            place("sphere", Sphere{glm::dvec3(sphere), sphere.w}, sides, {},
                  group.parts[0].material);
            return;
        }
        SphereSet set = make_sphere_set("spheres", relative(group.spheres), group.parts);
        place("spheres", SphereSetInstance{add_sphere_set(scene_, std::move(set))}, sides,
              translate(origin_), kNoMaterial);
    }

    void add(const NffCones& group, Sides sides) {
        if (group.ends.size() == 2) {
            place_cone(group.ends[0], group.ends[1], sides, group.parts[0].material);
            return;
        }
        NffCones flat;
        NffCones rest;
        const NffCones& together = separate_flat(group, flat, rest) ? rest : group;
        for (const Part& part : flat.parts) {
            for (std::size_t i = part.first; i < part.first + part.count; ++i)
                place_cone(flat.ends[2 * i], flat.ends[2 * i + 1], sides, part.material);
        }
        if (together.ends.empty()) return;
        ConeSet set = make_cone_set("cones", relative(together.ends), false, together.parts);
        place("cones", ConeSetInstance{add_cone_set(scene_, std::move(set))}, sides,
              translate(origin_), kNoMaterial);
    }

    void add(const NffTriangles& group, const std::string& name, Sides sides) {
        if (group.triangles.empty()) return;
        MeshData data;
        data.positions.reserve(group.positions.size());
        for (const glm::dvec3& p : group.positions)
            data.positions.emplace_back(p - origin_);
        data.normals.reserve(group.normals.size());
        for (const glm::dvec3& n : group.normals)
            data.normals.push_back(unit_or_zero(n));
        data.triangles = group.triangles;
        if (!data.normals.empty()) fill_normals(data);
        const MeshId mesh = add_mesh(scene_, make_mesh(name, std::move(data), group.parts));
        place(name, MeshInstance{mesh}, sides, translate(origin_), kNoMaterial);
    }

    void add(const NffPlane& plane) {
        place("plane", plane.plane, plane.sides, {}, plane.material);
    }

private:
    // In double precision.
    void place_cone(const glm::dvec4& base, const glm::dvec4& apex, Sides sides,
                    MaterialId material) {
        place("cone", Cone{glm::dvec3(base), glm::dvec3(apex), base.w, apex.w, false}, sides, {},
              material);
    }

    // Divides a group if it has cones whose ends are one point as the floats of a set: each of them
    // must be an object of its own.
    bool separate_flat(const NffCones& group, NffCones& flat, NffCones& rest) const {
        const auto stored = [&](std::size_t end) {
            return glm::vec3(glm::dvec3(group.ends[end]) - origin_);
        };
        const auto is_flat = [&](std::size_t i) { return stored(2 * i) == stored(2 * i + 1); };
        std::size_t first = 0;
        while (first < group.size() && !is_flat(first))
            ++first;
        if (first == group.size()) return false;
        for (const Part& part : group.parts) {
            for (std::size_t i = part.first; i < part.first + part.count; ++i) {
                NffCones& side = is_flat(i) ? flat : rest;
                side.ends.push_back(group.ends[2 * i]);
                side.ends.push_back(group.ends[2 * i + 1]);
                side.add(1, part.material);
            }
        }
        return true;
    }

    [[nodiscard]] std::vector<glm::vec4> relative(const std::vector<glm::dvec4>& spheres) const {
        std::vector<glm::vec4> result;
        result.reserve(spheres.size());
        for (const glm::dvec4& sphere : spheres)
            result.emplace_back(sphere - glm::dvec4(origin_, 0.0));
        return result;
    }

    void place(const std::string& name, const Shape& shape, Sides sides, const Transform& transform,
               MaterialId material) {
        Object object;
        object.name = name;
        object.shape = shape;
        object.world_from_object = transform;
        object.material = material;
        object.sides = sides;
        add_object(scene_, std::move(object));
    }

    Scene& scene_;
    glm::dvec3 origin_;
};

// Haines: lights without a stated intensity have sqrt(n) / (2 n), n being the number of lights.
void add_lights(Scene& scene, const std::vector<NffLight>& lights) {
    const auto n = static_cast<double>(lights.size());
    const glm::vec3 unstated(static_cast<float>(std::sqrt(n) / (2.0 * n)));
    for (const NffLight& light : lights) {
        PointLight point;
        point.name = fmt::format("light {}", scene.lights.size() + 1);
        point.position = light.position;
        point.colour = light.colour.value_or(unstated);
        scene.lights.emplace_back(point);
    }
}

}  // namespace

LoadedScene load_nff(const std::filesystem::path& file, const LoadOptions& options) {
    LoadedScene loaded = begin_scene(options);
    const FileText bytes(file);
    const std::string text = without_nff_comments(bytes.view());
    NffContent content = NffReader(file.string(), text, options, loaded.warnings).read();

    Scene& scene = loaded.scene;
    scene.materials = std::move(content.materials);
    scene.background = content.background;
    scene.ambient = glm::vec3(kAmbient);
    add_lights(scene, content.lights);
    if (content.camera) scene.cameras.push_back({"view", *content.camera});

    NffScene placed(scene, storage_origin(bounds_of(content)));
    for (const Sides sides : {Sides::front_only, Sides::back_only, Sides::both}) {
        const auto i = static_cast<std::size_t>(sides);
        placed.add(content.spheres[i], sides);
        placed.add(content.cones[i], sides);
        placed.add(content.polygons[i], "polygons", sides);
        placed.add(content.patches[i], "patches", sides);
        load_step(options, 0.95f);
    }
    for (const NffPlane& plane : content.planes)
        placed.add(plane);
    if (scene.objects.empty()) throw FileError(file.string(), "has no objects: nothing to show");
    return loaded;
}

}  // namespace raypick
