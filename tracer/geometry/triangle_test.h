// The one ray-triangle test: watertight, in double, independent of the order of the corners.
//
// Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The edge
// functions of two triangles that share an edge are exact negatives of each other, so no ray slips
// between them. Sheared coordinates are left multiplied by the direction's largest component, which
// takes a division less. Sums of three terms are symmetric, so that neither the winding nor the
// first corner changes a bit of t.
#pragma once

#include "tracer/geometry/absolute.h"
#include "tracer/geometry/shapes.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace raypick {

// A ray in coordinates in which it runs along +z from 0.
struct ShearedRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, 1.0};
    int kx = 0;
    int ky = 1;
    int kz = 2;
    double sx = 0.0;
    double sy = 0.0;
    double sz = 1.0;
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
    s.sz = 1.0 / ray.direction[s.kz];
    s.sx = ray.direction[s.kx] * s.sz;
    s.sy = ray.direction[s.ky] * s.sz;
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
    const glm::dvec3 pa = a - ray.origin;
    const glm::dvec3 pb = b - ray.origin;
    const glm::dvec3 pc = c - ray.origin;
    const double dz = ray.direction[ray.kz];
    const auto across = [&](const glm::dvec3& p, int k) {
        return p[k] * dz - ray.direction[k] * p[ray.kz];
    };
    const double ax = across(pa, ray.kx);
    const double ay = across(pa, ray.ky);
    const double bx = across(pb, ray.kx);
    const double by = across(pb, ray.ky);
    const double cx = across(pc, ray.kx);
    const double cy = across(pc, ray.ky);
    const double u = cx * by - cy * bx;
    const double v = ax * cy - ay * cx;
    const double w = bx * ay - by * ax;
    const bool positive = u >= 0.0 && v >= 0.0 && w >= 0.0;
    const bool negative = u <= 0.0 && v <= 0.0 && w <= 0.0;
    if (!(positive || negative)) return std::nullopt;
    const double determinant = symmetric_sum(u, v, w);
    if (!(std::abs(determinant) > 0.0)) return std::nullopt;
    // Corners on one line leave a determinant of rounding errors; this product is exact for floats.
    if (glm::cross(b - a, c - a) == glm::dvec3(0.0)) return std::nullopt;
    const double scaled = symmetric_sum(u * pa[ray.kz], v * pb[ray.kz], w * pc[ray.kz]);
    const double inverse = 1.0 / (determinant * dz);
    TriangleHit hit;
    hit.t = scaled * inverse;
    hit.u = v * (dz * inverse);
    hit.v = w * (dz * inverse);
    hit.front_face = determinant > 0.0;
    return hit;
}

}  // namespace raypick
