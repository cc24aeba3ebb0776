#include "tracer/accel/surface.h"

#include "tracer/geometry/triangle_test.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace raypick {

namespace {

// Object-space position and outward normals, not normalised.
struct LocalPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 geometric_normal{0.0};
    glm::dvec3 shading_normal{0.0};
};

// The point a u v of the plane through the corners, exact to double rounding.
LocalPoint triangle_point(const ObjectRay& ray, const Hit& hit, const glm::dvec3& a,
                          const glm::dvec3& b, const glm::dvec3& c) {
    glm::dvec2 uv(hit.uv);
    if (const auto exact = intersect_triangle(shear(ray), a, b, c)) uv = {exact->u, exact->v};
    LocalPoint point;
    point.position = (1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c;
    point.geometric_normal = glm::cross(b - a, c - a);
    point.shading_normal = point.geometric_normal;
    return point;
}

// Interpolated where the mesh has normals, turned to the side of the geometric normal.
glm::dvec3 mesh_shading_normal(const Mesh& mesh, const glm::uvec3& corner, const Hit& hit,
                               const glm::dvec3& geometric_normal) {
    if (mesh.normals.empty()) return geometric_normal;
    const auto u = static_cast<double>(hit.uv.x);
    const auto v = static_cast<double>(hit.uv.y);
    const glm::dvec3 normal = (1.0 - u - v) * glm::dvec3(mesh.normals[corner.x]) +
                              u * glm::dvec3(mesh.normals[corner.y]) +
                              v * glm::dvec3(mesh.normals[corner.z]);
    if (!(glm::dot(normal, normal) > 1e-12)) return geometric_normal;
    return glm::dot(normal, geometric_normal) < 0.0 ? -normal : normal;
}

struct LocalPointOf {
    const Scene& scene;
    const ObjectRay& ray;
    const Hit& hit;

    LocalPoint operator()(const Sphere& sphere) const {
        const glm::dvec3 p = at_t() - sphere.centre;
        const glm::dvec3 n = glm::normalize(p);
        return {sphere.centre + sphere.radius * n, n, n};
    }

    LocalPoint operator()(const Plane& plane) const {
        const glm::dvec3 p = at_t();
        const double height = glm::dot(plane.normal, p) + plane.d;
        const glm::dvec3 foot = p - plane.normal * (height / glm::dot(plane.normal, plane.normal));
        return {foot, plane.normal, plane.normal};
    }

    LocalPoint operator()(const Box& box) const {
        const int axis = static_cast<int>(hit.primitive / 2);
        const bool upper = hit.primitive % 2 != 0;
        LocalPoint point;
        point.position = glm::clamp(at_t(), box.min, box.max);
        point.position[axis] = upper ? box.max[axis] : box.min[axis];
        point.geometric_normal[axis] = upper ? 1.0 : -1.0;
        point.shading_normal = point.geometric_normal;
        return point;
    }

    LocalPoint operator()(const Triangle& triangle) const {
        return triangle_point(ray, hit, triangle.a, triangle.b, triangle.c);
    }

    LocalPoint operator()(const MeshInstance& instance) const {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const glm::uvec3 corner = mesh.triangles[hit.primitive];
        LocalPoint point = triangle_point(ray, hit, glm::dvec3(mesh.positions[corner.x]),
                                          glm::dvec3(mesh.positions[corner.y]),
                                          glm::dvec3(mesh.positions[corner.z]));
        point.shading_normal = mesh_shading_normal(mesh, corner, hit, point.geometric_normal);
        return point;
    }

    [[nodiscard]] glm::dvec3 at_t() const {
        return ray.origin + static_cast<double>(hit.t) * ray.direction;
    }
};

}  // namespace

SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit) {
    const Object& object = scene.objects[object_index(scene, hit.object)];
    const Transform object_from_world = inverse(object.world_from_object).value_or(Transform{});
    const ObjectRay local{object_from_world.point(glm::dvec3(ray.origin)),
                          object_from_world.vector(glm::dvec3(ray.direction))};
    const LocalPoint point = std::visit(LocalPointOf{scene, local, hit}, object.shape);
    const glm::dvec3 position = object.world_from_object.point(point.position);

    SurfacePoint surface;
    surface.position = glm::vec3(position);
    // Rounding to float, and the double arithmetic before it with room to spare.
    const glm::dvec3 reach = glm::abs(position) + glm::abs(object.world_from_object.translation);
    surface.position_error = glm::vec3(glm::abs(position) * 0x1p-24 + reach * 0x1p-48) +
                             std::numeric_limits<float>::min();
    surface.geometric_normal = glm::vec3(world_normal(object_from_world, point.geometric_normal));
    surface.shading_normal = glm::vec3(world_normal(object_from_world, point.shading_normal));
    surface.uv = hit.uv;
    surface.front_face = hit.front_face;
    surface.material = material_id(scene, object, hit.primitive);
    return surface;
}

glm::vec3 offset_origin(const SurfacePoint& point, const glm::vec3& direction) {
    const glm::vec3 normal = glm::dot(point.geometric_normal, direction) >= 0.0f
                                 ? point.geometric_normal
                                 : -point.geometric_normal;
    // Twice the bound: once for the point, once for the rounding of the sum.
    const float distance = 2.0f * glm::dot(glm::abs(normal), point.position_error);
    glm::vec3 origin = point.position + distance * normal;
    for (int axis = 0; axis < 3; ++axis) {
        if (normal[axis] == 0.0f) continue;
        const float outwards = std::copysign(std::numeric_limits<float>::infinity(), normal[axis]);
        origin[axis] = std::nextafter(origin[axis], outwards);
    }
    return origin;
}

}  // namespace raypick
