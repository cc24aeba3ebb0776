// Disk and rectangle.
#include "tracer/geometry/axis_frame.h"
#include "tracer/geometry/rectangle.h"
#include "tracer/geometry/shapes.h"
#include "tracer/geometry/triangle_test.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace raypick {

namespace {

// Where the ray meets the plane through `point`; nothing if it runs along it, or on a NaN.
std::optional<double> meet_plane(const ObjectRay& ray, const glm::dvec3& point,
                                 const glm::dvec3& normal) {
    const double t = glm::dot(normal, point - ray.origin) / glm::dot(normal, ray.direction);
    if (!std::isfinite(t)) return std::nullopt;
    return t;
}

// Whether the ray passes within the four corners: the edge test of triangle_test.h, so that no ray
// slips between rectangles, or a rectangle and a triangle, that share an edge.
bool passes_within(const ObjectRay& ray, const std::array<glm::dvec3, 4>& corners) {
    const ShearedRay sheared = shear(ray);
    std::array<glm::dvec2, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
        p[i] = sheared.across(corners[i]);
    bool left = true;
    bool right = true;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2& a = p[i];
        const glm::dvec2& b = p[(i + 1) % 4];
        const double side = b.x * a.y - b.y * a.x;
        left = left && side >= 0.0;
        right = right && side <= 0.0;
    }
    return left != right;  // both: seen edge on
}

}  // namespace

ShapeHits intersect(const Disk& disk, const ObjectRay& ray) {
    const auto t = meet_plane(ray, disk.centre, disk.normal);
    if (!t) return {};
    const glm::dvec3 from_centre = (ray.origin - disk.centre) + *t * ray.direction;
    const double distance = glm::length(from_centre);
    if (!(distance >= disk.inner_radius && distance <= disk.radius)) return {};
    const AxisFrame frame = axis_frame(disk.normal);
    ShapeHit hit;
    hit.t = *t;
    hit.normal = disk.normal;
    hit.uv = {turn(glm::dot(from_centre, frame.x), glm::dot(from_centre, frame.z)),
              distance / disk.radius};
    return {{{hit}}, 1};
}

glm::dvec3 rectangle_normal(const Rectangle& rectangle) {
    return glm::cross(rectangle.edge_u, rectangle.edge_v);
}

std::optional<double> meet_plane_of(const Rectangle& rectangle, const ObjectRay& ray) {
    return meet_plane(ray, rectangle.corner, rectangle_normal(rectangle));
}

bool passes_within(const Rectangle& rectangle, const ObjectRay& ray) {
    const glm::dvec3& a = rectangle.corner;
    const glm::dvec3 b = a + rectangle.edge_u;
    return passes_within(ray, {a, b, b + rectangle.edge_v, a + rectangle.edge_v});
}

bool meet_within(const Rectangle& rectangle, const ObjectRay& ray, ShapeHit& hit) {
    const glm::dvec3& a = rectangle.corner;
    const glm::dvec3 normal = rectangle_normal(rectangle);
    const auto t = meet_plane(ray, a, normal);
    if (!t) return false;
    const glm::dvec3 from_corner = (ray.origin - a) + *t * ray.direction;
    const double squared_area = glm::dot(normal, normal);
    const double u = glm::dot(glm::cross(from_corner, rectangle.edge_v), normal) / squared_area;
    const double v = glm::dot(glm::cross(rectangle.edge_u, from_corner), normal) / squared_area;
    hit.t = *t;
    hit.uv.x = std::clamp(u, 0.0, 1.0);
    hit.uv.y = std::clamp(v, 0.0, 1.0);
    hit.normal = normal;
    hit.primitive = 0;
    return true;
}

ShapeHits intersect(const Rectangle& rectangle, const ObjectRay& ray) {
    ShapeHits hits;
    if (!passes_within(rectangle, ray)) return hits;
    if (meet_within(rectangle, ray, hits.hit[0])) hits.count = 1;
    return hits;
}

}  // namespace raypick
