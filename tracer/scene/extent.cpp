// How far things reach, and where the scene's origin goes.
#include "tracer/parallel/parallel.h"
#include "tracer/scene/scene.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

namespace raypick {

namespace {

// Beyond this many extents from 0, float coordinates would cost the scene bits that it can use.
constexpr double kFarInExtents = 8.0;

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

// How far a circle of radius 1 about the axis reaches along each coordinate axis.
glm::dvec3 circle_reach(const glm::dvec3& axis) {
    const glm::dvec3 squares = axis * axis;
    const double sum = squares.x + squares.y + squares.z;
    return glm::sqrt(
        glm::dvec3(squares.y + squares.z, squares.z + squares.x, squares.x + squares.y) / sum);
}

std::optional<ObjectExtent> extent(const Disk& d) {
    const glm::dvec3 reach = d.radius * circle_reach(d.normal);
    return ObjectExtent{d.centre - reach, d.centre + reach};
}
std::optional<ObjectExtent> extent(const Rectangle& r) {
    const glm::dvec3 u = r.corner + r.edge_u;
    const glm::dvec3 v = r.corner + r.edge_v;
    const glm::dvec3 uv = u + r.edge_v;
    return ObjectExtent{glm::min(glm::min(r.corner, uv), glm::min(u, v)),
                        glm::max(glm::max(r.corner, uv), glm::max(u, v))};
}
std::optional<ObjectExtent> extent(const Cone& c) {
    return shape_extent(c);
}
// The points within minor_radius of a circle.
std::optional<ObjectExtent> extent(const Torus& t) {
    const glm::dvec3 reach = t.major_radius * circle_reach(t.axis) + t.minor_radius;
    return ObjectExtent{t.centre - reach, t.centre + reach};
}

std::optional<ObjectExtent> united(const std::optional<ObjectExtent>& a,
                                   const std::optional<ObjectExtent>& b) {
    if (!a || !b) return a ? a : b;
    return ObjectExtent{glm::min(a->min, b->min), glm::max(a->max, b->max)};
}

std::optional<ObjectExtent> set_extent(const SphereSet& set) {
    std::optional<ObjectExtent> all;
    for (std::uint32_t i = 0; i < set.spheres.size(); ++i)
        all = united(all, extent(sphere_of(set, i)));
    return all;
}
std::optional<ObjectExtent> set_extent(const ConeSet& set) {
    std::optional<ObjectExtent> all;
    for (std::uint32_t i = 0; i < set.size(); ++i)
        all = united(all, extent(cone_of(set, i)));
    return all;
}

// The extents of what many objects may share, each worked out once.
class SharedExtents {
public:
    explicit SharedExtents(const Scene& scene) : scene_(scene) {
        constexpr std::size_t kFewTriangles = 100'000;  // waking threads would take longer
        std::size_t triangles = 0;
        for (const Mesh& mesh : scene.meshes)
            triangles += mesh.triangles.size();
        meshes_.resize(scene.meshes.size());
        parallel_for(meshes_.size(), triangles > kFewTriangles ? 0 : 1, {},
                     [&](std::size_t i) { meshes_[i] = mesh_extent(scene.meshes[i]); });
        for (const SphereSet& set : scene.sphere_sets)
            sphere_sets_.push_back(set_extent(set));
        for (const ConeSet& set : scene.cone_sets)
            cone_sets_.push_back(set_extent(set));
    }

    [[nodiscard]] std::optional<ObjectExtent> of(const Shape& shape) const {
        if (const auto* mesh = std::get_if<MeshInstance>(&shape)) return meshes_[mesh->mesh];
        if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
            return sphere_sets_[spheres->set];
        }
        if (const auto* cones = std::get_if<ConeSetInstance>(&shape)) {
            return cone_sets_[cones->set];
        }
        return object_extent(scene_, shape);
    }

private:
    const Scene& scene_;
    std::vector<std::optional<ObjectExtent>> meshes_;
    std::vector<std::optional<ObjectExtent>> sphere_sets_;
    std::vector<std::optional<ObjectExtent>> cone_sets_;
};

// Calls body(object, extent) for the finite visible objects.
template <typename Body>
void for_each_finite_object(const Scene& scene, const Body& body) {
    const SharedExtents extents(scene);
    for (const Object& object : scene.objects) {
        if (object.mask == 0) continue;
        const std::optional<ObjectExtent> local = extents.of(object.shape);
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
        all = united(all, world_extent(object.world_from_object, local));
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

struct ExtentOf {
    const Scene& scene;

    std::optional<ObjectExtent> operator()(const MeshInstance& instance) const {
        return mesh_extent(scene.meshes[instance.mesh]);
    }
    std::optional<ObjectExtent> operator()(const SphereSetInstance& instance) const {
        return set_extent(scene.sphere_sets[instance.set]);
    }
    std::optional<ObjectExtent> operator()(const ConeSetInstance& instance) const {
        return set_extent(scene.cone_sets[instance.set]);
    }
    template <typename SimpleShape>
    std::optional<ObjectExtent> operator()(const SimpleShape& shape) const {
        return extent(shape);
    }
};

void shift(Scene& scene, const glm::dvec3& offset) {
    for (Object& object : scene.objects)
        object.world_from_object.translation += offset;
    for (Light& light : scene.lights) {
        std::visit(
            [&offset](auto& kind) {
                if constexpr (requires { kind.position; }) kind.position += offset;
                if constexpr (requires { kind.centre; }) kind.centre += offset;
                if constexpr (requires { kind.corner; }) kind.corner += offset;
            },
            light);
    }
    for (NamedCamera& named : scene.cameras) {
        named.camera.eye += offset;
        named.camera.at += offset;
    }
}

}  // namespace

ObjectExtent shape_extent(const Cone& c) {
    const glm::dvec3 reach = circle_reach(c.apex - c.base);
    const glm::dvec3 base = c.base_radius * reach;
    const glm::dvec3 apex = c.apex_radius * reach;
    return {glm::min(c.base - base, c.apex - apex), glm::max(c.base + base, c.apex + apex)};
}

std::optional<ObjectExtent> object_extent(const Scene& scene, const Shape& shape) {
    return std::visit(ExtentOf{scene}, shape);
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
