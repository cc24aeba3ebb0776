// The one ray-triangle test: watertight, in double, independent of the order of the corners.
//
// Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The edge
// functions of two triangles that share an edge are exact negatives of each other, so no ray slips
// between them. Sheared coordinates are left multiplied by the direction's largest component, so
// that nothing is divided by it. Sums of three terms are symmetric, so that neither the winding nor
// the first corner changes a bit of t.
#pragma once

#include "tracer/geometry/absolute.h"
#include "tracer/geometry/shapes.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace raypick {

// A ray that a shear turns into one along kz, the axis that it runs along most. The order of the
// others keeps the winding of what is seen along it.
struct ShearedRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, 1.0};
    int kx = 0;
    int ky = 1;
    int kz = 2;

    // How far ahead the point is along kz. One by one: an index into what was just put together
    // makes processors wait.
    [[nodiscard]] double ahead(const glm::dvec3& point) const { return point[kz] - origin[kz]; }
    // Where it is seen along the ray, times the direction's component along kz.
    [[nodiscard]] glm::dvec2 across(const glm::dvec3& point) const {
        const auto seen = [&](int k) {
            return (point[k] - origin[k]) * direction[kz] - direction[k] * ahead(point);
        };
        return {seen(kx), seen(ky)};
    }
};

inline ShearedRay shear(const ObjectRay& ray) {
    const glm::dvec3 d = absolute(ray.direction);
    ShearedRay s;
    s.origin = ray.origin;
    s.direction = ray.direction;
    s.kz = d.x > d.y ? (d.x > d.z ? 0 : 2) : (d.y > d.z ? 1 : 2);
    s.kx = (s.kz + 1) % 3;
    s.ky = (s.kx + 1) % 3;
    if (ray.direction[s.kz] < 0.0) std::swap(s.kx, s.ky);  // keeps the winding
    return s;
}

// The same whatever the order of the arguments, and the opposite if all of them are.
inline double symmetric_sum(double a, double b, double c) {
    const double lower = std::min(a, b);
    const double higher = std::max(a, b);
    const double middle = std::min(higher, c);
    const double highest = std::max(higher, c);
    return (std::min(lower, middle) + highest) + std::max(lower, middle);
}

struct TriangleHit {
    double t = 0.0;
    double u = 0.0;  // weight of corner b
    double v = 0.0;  // weight of corner c
    bool front_face = false;
};

// Degenerate triangles, NaNs and rays in the triangle's plane miss.
inline std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, const glm::dvec3& a,
                                                     const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec2 pa = ray.across(a);
    const glm::dvec2 pb = ray.across(b);
    const glm::dvec2 pc = ray.across(c);
    const double u = pc.x * pb.y - pc.y * pb.x;
    const double v = pa.x * pc.y - pa.y * pc.x;
    const double w = pb.x * pa.y - pb.y * pa.x;
    const bool positive = u >= 0.0 && v >= 0.0 && w >= 0.0;
    const bool negative = u <= 0.0 && v <= 0.0 && w <= 0.0;
    if (!(positive || negative)) return std::nullopt;
    const double determinant = symmetric_sum(u, v, w);
    if (!(std::abs(determinant) > 0.0)) return std::nullopt;
    // Corners on one line leave a determinant of rounding errors; this product is exact for floats.
    if (glm::cross(b - a, c - a) == glm::dvec3(0.0)) return std::nullopt;
    const double scaled = symmetric_sum(u * ray.ahead(a), v * ray.ahead(b), w * ray.ahead(c));
    const double dz = ray.direction[ray.kz];
    const double inverse = 1.0 / (determinant * dz);
    TriangleHit hit;
    hit.t = scaled * inverse;
    hit.u = v * (dz * inverse);
    hit.v = w * (dz * inverse);
    hit.front_face = determinant > 0.0;
    return hit;
}

}  // namespace raypick
