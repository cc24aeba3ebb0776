#include "tracer/scene/scene.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

// Beyond this many extents from 0, float coordinates would cost the scene bits that it can use.
constexpr double kFarInExtents = 8.0;

std::string unique_name(Scene& scene, std::string name) {
    if (name.empty()) name = "object";
    const auto [entry, is_new] = scene.used_names.try_emplace(name, 1u);
    if (is_new) return name;
    // References into the map survive its growth, iterators do not.
    std::uint32_t& last_number = entry->second;
    while (true) {
        std::string numbered = fmt::format("{}#{}", name, ++last_number);
        if (scene.used_names.try_emplace(numbered, 1u).second) return numbered;
    }
}

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Of the vertices that triangles use, leaving out those that are no point at all.
std::optional<ObjectExtent> mesh_extent(const Mesh& mesh) {
    Bounds bounds;
    for (const glm::uvec3& t : mesh.triangles) {
        for (const std::uint32_t index : {t.x, t.y, t.z}) {
            const glm::vec3& p = mesh.positions[index];
            if (finite(p)) bounds.extend(p);
        }
    }
    if (bounds.empty()) return std::nullopt;
    return ObjectExtent{bounds.min, bounds.max};
}

std::optional<ObjectExtent> extent(const Sphere& s) {
    return ObjectExtent{s.centre - s.radius, s.centre + s.radius};
}
std::optional<ObjectExtent> extent(const Plane&) {
    return std::nullopt;
}
std::optional<ObjectExtent> extent(const Triangle& t) {
    return ObjectExtent{glm::min(glm::min(t.a, t.b), t.c), glm::max(glm::max(t.a, t.b), t.c)};
}
std::optional<ObjectExtent> extent(const Box& b) {
    return ObjectExtent{b.min, b.max};
}

// The extents of all meshes, each worked out once: many instances may share a mesh.
std::vector<std::optional<ObjectExtent>> mesh_extents(const Scene& scene) {
    std::vector<std::optional<ObjectExtent>> extents;
    extents.reserve(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes)
        extents.push_back(mesh_extent(mesh));
    return extents;
}

// Calls body(object, extent) for the finite visible objects.
template <typename Body>
void for_each_finite_object(const Scene& scene, const Body& body) {
    const std::vector<std::optional<ObjectExtent>> meshes = mesh_extents(scene);
    for (const Object& object : scene.objects) {
        if (object.mask == 0) continue;
        const MeshInstance* instance = std::get_if<MeshInstance>(&object.shape);
        const std::optional<ObjectExtent> local =
            instance ? meshes[instance->mesh] : object_extent(scene, object.shape);
        if (local) body(object, *local);
    }
}

// As world_bounds, but in double.
ObjectExtent world_extent(const Transform& world_from_object, const ObjectExtent& local) {
    const glm::dvec3 centre = world_from_object.point(0.5 * local.min + 0.5 * local.max);
    const glm::dvec3 half = 0.5 * (local.max - local.min);
    const glm::dmat3& m = world_from_object.linear;
    const glm::dvec3 reach =
        glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y + glm::abs(m[2]) * half.z;
    return {centre - reach, centre + reach};
}

std::optional<ObjectExtent> scene_extent(const Scene& scene) {
    std::optional<ObjectExtent> all;
    for_each_finite_object(scene, [&all](const Object& object, const ObjectExtent& local) {
        const ObjectExtent world = world_extent(object.world_from_object, local);
        all = all ? ObjectExtent{glm::min(all->min, world.min), glm::max(all->max, world.max)}
                  : world;
    });
    return all;
}

// A round number near the centre: whole, or for small scenes a multiple of a power of two, so that
// adding it back gives the file's coordinates without new rounding.
glm::dvec3 round_origin(const glm::dvec3& centre, double largest_extent) {
    if (largest_extent == 0.0) return centre;
    const double grid = std::min(1.0, std::exp2(std::floor(std::log2(largest_extent / 8.0))));
    return glm::round(centre / grid) * grid;
}

void shift(Scene& scene, const glm::dvec3& offset) {
    for (Object& object : scene.objects)
        object.world_from_object.translation += offset;
    for (Light& light : scene.lights) {
        if (PointLight* point = std::get_if<PointLight>(&light)) point->position += offset;
    }
    for (NamedCamera& named : scene.cameras) {
        named.camera.eye += offset;
        named.camera.at += offset;
    }
}

}  // namespace

ObjectId add_object(Scene& scene, Object object) {
    object.id = scene.next_object_id++;
    object.name = unique_name(scene, std::move(object.name));
    if (object.path.empty()) object.path = "/" + object.name;
    scene.objects.push_back(std::move(object));
    return scene.objects.back().id;
}

MaterialId add_material(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return static_cast<MaterialId>(scene.materials.size() - 1);
}

MeshId add_mesh(Scene& scene, Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    return static_cast<MeshId>(scene.meshes.size() - 1);
}

const Object* find_object(const Scene& scene, ObjectId id) {
    if (scene.objects.empty() || id < scene.objects.front().id) return nullptr;
    // Ids only have gaps where objects were taken away.
    const std::size_t guess = id - scene.objects.front().id;
    if (guess < scene.objects.size() && scene.objects[guess].id == id) return &scene.objects[guess];
    const auto found =
        std::lower_bound(scene.objects.begin(), scene.objects.end(), id,
                         [](const Object& object, ObjectId wanted) { return object.id < wanted; });
    return found != scene.objects.end() && found->id == id ? &*found : nullptr;
}

std::size_t object_index(const Scene& scene, ObjectId id) {
    const Object* object = find_object(scene, id);
    assert(object != nullptr);
    return static_cast<std::size_t>(object - scene.objects.data());
}

MaterialId material_id(const Scene& scene, const Object& object, std::uint32_t primitive) {
    if (object.material != kNoMaterial) return object.material;
    const MeshInstance* instance = std::get_if<MeshInstance>(&object.shape);
    if (instance == nullptr) return kNoMaterial;
    const Part* part = part_of(scene.meshes[instance->mesh], primitive);
    return part != nullptr ? part->material : kNoMaterial;
}

const Material& material(const Scene& scene, MaterialId id) {
    static const Material grey;
    return id < scene.materials.size() ? scene.materials[id] : grey;
}

std::uint32_t primitive_count(const Scene& scene, const Object& object) {
    if (const MeshInstance* instance = std::get_if<MeshInstance>(&object.shape)) {
        return static_cast<std::uint32_t>(scene.meshes[instance->mesh].triangles.size());
    }
    return std::holds_alternative<Box>(object.shape) ? 6u : 1u;
}

std::optional<ObjectExtent> object_extent(const Scene& scene, const Shape& shape) {
    if (const MeshInstance* instance = std::get_if<MeshInstance>(&shape)) {
        return mesh_extent(scene.meshes[instance->mesh]);
    }
    if (const Sphere* sphere = std::get_if<Sphere>(&shape)) return extent(*sphere);
    if (const Plane* plane = std::get_if<Plane>(&shape)) return extent(*plane);
    if (const Triangle* triangle = std::get_if<Triangle>(&shape)) return extent(*triangle);
    return extent(std::get<Box>(shape));
}

Bounds object_bounds(const Scene& scene, const Object& object) {
    const std::optional<ObjectExtent> local = object_extent(scene, object.shape);
    return local ? world_bounds(object.world_from_object, local->min, local->max) : Bounds{};
}

Bounds scene_bounds(const Scene& scene) {
    Bounds bounds;
    for_each_finite_object(scene, [&bounds](const Object& object, const ObjectExtent& local) {
        bounds.extend(world_bounds(object.world_from_object, local.min, local.max));
    });
    return bounds;
}

void choose_origin(Scene& scene) {
    const std::optional<ObjectExtent> bounds = scene_extent(scene);
    if (!bounds) return;
    const glm::dvec3 centre = 0.5 * bounds->min + 0.5 * bounds->max;
    const glm::dvec3 size = bounds->max - bounds->min;
    const double largest_extent = std::max({size.x, size.y, size.z});
    const glm::dvec3 off = glm::abs(centre);
    const double distance = std::max({off.x, off.y, off.z});
    // Written so that a NaN or an infinity leaves the scene alone.
    if (!(distance > kFarInExtents * largest_extent) || !std::isfinite(distance)) return;
    const glm::dvec3 origin = round_origin(centre, largest_extent);
    shift(scene, -origin);
    scene.origin += origin;
}

}  // namespace raypick
