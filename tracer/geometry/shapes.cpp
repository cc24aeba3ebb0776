#include "tracer/geometry/shapes.h"

#include "tracer/geometry/absolute.h"
#include "tracer/geometry/sphere_uv.h"
#include "tracer/geometry/triangle_test.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

// The coordinates other than the one along which the plane's normal is longest.
glm::dvec2 plane_uv(const Plane& plane, const glm::dvec3& p) {
    const glm::dvec3 n = absolute(plane.normal);
    if (n.x > n.y && n.x > n.z) return {p.y, p.z};
    return n.y >= n.z ? glm::dvec2(p.x, p.z) : glm::dvec2(p.x, p.y);
}

// How far along an axis of the box the point lies, 0 to 1; 0 along one on which the box is flat.
double box_share(const Box& box, const glm::dvec3& p, int axis) {
    const double extent = box.max[axis] - box.min[axis];
    return extent > 0.0 ? std::clamp((p[axis] - box.min[axis]) / extent, 0.0, 1.0) : 0.0;
}

ShapeHit box_hit(const Box& box, const ObjectRay& ray, double t, int axis, bool upper) {
    ShapeHit hit;
    hit.t = t;
    hit.primitive = static_cast<std::uint32_t>(2 * axis + (upper ? 1 : 0));
    hit.normal[axis] = upper ? 1.0 : -1.0;
    const glm::dvec3 p = ray.origin + t * ray.direction;
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    hit.uv = {box_share(box, p, i), box_share(box, p, j)};
    return hit;
}

}  // namespace

ShapeHit sphere_hit(const Sphere& sphere, const ObjectRay& ray, double t) {
    ShapeHit hit;
    hit.t = t;
    hit.normal = (ray.origin + t * ray.direction - sphere.centre) / sphere.radius;
    hit.uv = sphere_uv(glm::normalize(hit.normal));
    return hit;
}

// Numerically robust form of the quadratic: Haines, Guenther, Akenine-Moeller, "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019.
std::optional<SphereRoots> sphere_roots(const Sphere& sphere, const ObjectRay& ray) {
    const glm::dvec3 f = ray.origin - sphere.centre;
    const double a = glm::dot(ray.direction, ray.direction);
    const double b = -glm::dot(f, ray.direction);
    const glm::dvec3 closest = f + (b / a) * ray.direction;
    const double squared_radius = sphere.radius * sphere.radius;
    const double discriminant = squared_radius - glm::dot(closest, closest);
    if (!(discriminant >= 0.0)) return std::nullopt;
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    const double c = glm::dot(f, f) - squared_radius;
    double t0 = q != 0.0 ? c / q : 0.0;
    double t1 = q / a;
    if (t0 > t1) std::swap(t0, t1);
    return SphereRoots{{t0, t1}};
}

ShapeHits intersect(const Sphere& sphere, const ObjectRay& ray) {
    const auto roots = sphere_roots(sphere, ray);
    if (!roots) return {};
    return {{{sphere_hit(sphere, ray, roots->t[0]), sphere_hit(sphere, ray, roots->t[1])}}, 2};
}

// The notes' ray-plane formula with the plane's d, which they drop.
ShapeHits intersect(const Plane& plane, const ObjectRay& ray) {
    const double slope = glm::dot(plane.normal, ray.direction);
    const double height = glm::dot(plane.normal, ray.origin) + plane.d;
    const double t = -height / slope;
    if (!std::isfinite(t)) return {};  // parallel, or a NaN
    ShapeHit hit;
    hit.t = t;
    hit.normal = plane.normal;
    hit.uv = plane_uv(plane, ray.origin + hit.t * ray.direction);
    return {{{hit}}, 1};
}

ShapeHits intersect(const Triangle& triangle, const ObjectRay& ray) {
    const auto found = intersect_triangle(shear(ray), triangle.a, triangle.b, triangle.c);
    if (!found) return {};
    ShapeHit hit;
    hit.t = found->t;
    hit.uv = {found->u, found->v};
    hit.normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    return {{{hit}}, 1};
}

ShapeHits intersect(const Box& box, const ObjectRay& ray) {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    int enter_axis = 0;
    int leave_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0.0) {
            if (!(ray.origin[axis] >= box.min[axis] && ray.origin[axis] <= box.max[axis]))
                return {};
            continue;
        }
        const bool forward = ray.direction[axis] > 0.0;
        const double first = forward ? box.min[axis] : box.max[axis];
        const double second = forward ? box.max[axis] : box.min[axis];
        const double t0 = (first - ray.origin[axis]) / ray.direction[axis];
        const double t1 = (second - ray.origin[axis]) / ray.direction[axis];
        if (!(t0 <= t1)) return {};  // a NaN misses
        if (t0 > enter) {
            enter = t0;
            enter_axis = axis;
        }
        if (t1 < leave) {
            leave = t1;
            leave_axis = axis;
        }
    }
    if (!(enter <= leave) || !std::isfinite(enter) || !std::isfinite(leave)) return {};
    return {{{box_hit(box, ray, enter, enter_axis, ray.direction[enter_axis] < 0.0),
              box_hit(box, ray, leave, leave_axis, ray.direction[leave_axis] > 0.0)}},
            2};
}

}  // namespace raypick
