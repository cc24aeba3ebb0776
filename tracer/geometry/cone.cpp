// The truncated cone, as the convex body between its caps: the part of the ray between the two
// planes and the part within the side are intervals, and the body is where they overlap. So a ray
// from the inside of a capped cone always meets it.
#include "tracer/geometry/cone.h"

#include "tracer/geometry/axis_frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace raypick {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
    double from = -kInfinity;
    double to = kInfinity;
};

ConeProfile profile_of(const Cone& cone) {
    const glm::dvec3 axis = cone.apex - cone.base;
    const double length = glm::length(axis);
    return {axis / length, length, (cone.apex_radius - cone.base_radius) / length};
}

// Counted from the point nearest to the cone's middle, so that far origins cost no precision.
AxialRay axial_ray(const Cone& cone, const ConeProfile& profile, const ObjectRay& ray) {
    const glm::dvec3 middle = 0.5 * cone.base + 0.5 * cone.apex;
    AxialRay result;
    result.start =
        glm::dot(middle - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
    const glm::dvec3 p = (ray.origin - cone.base) + result.start * ray.direction;
    result.height = glm::dot(p, profile.axis);
    result.climb = glm::dot(ray.direction, profile.axis);
    result.across = p - result.height * profile.axis;
    result.drift = ray.direction - result.climb * profile.axis;
    return result;
}

// Between the planes of base and apex. Comparisons are arranged so that NaN means miss.
std::optional<Interval> between_planes(const AxialRay& ray, double length) {
    if (ray.climb == 0.0) {
        if (!(ray.height >= 0.0 && ray.height <= length)) return std::nullopt;
        return Interval{};
    }
    const double at_base = -ray.height / ray.climb;
    const double at_apex = (length - ray.height) / ray.climb;
    if (!std::isfinite(at_base) || !std::isfinite(at_apex)) return std::nullopt;
    return Interval{std::min(at_base, at_apex), std::max(at_base, at_apex)};
}

// Where the ray is nearest to the axis, without leaving the planes' interval.
double nearest_to_axis(const AxialRay& ray, const Interval& planes) {
    const double squared_drift = glm::dot(ray.drift, ray.drift);
    const double t = squared_drift > 0.0 ? -glm::dot(ray.across, ray.drift) / squared_drift : 0.0;
    return std::max(planes.from, std::min(planes.to, t));
}

// Within the side's infinite cone, on the nappe that the planes cut out: where
//   |across + t drift|^2 <= (radius + t growth)^2,  radius + t growth >= 0.
// The quadratic is solved without cancellation, see the sphere.
std::optional<Interval> within_side(const AxialRay& ray, double radius, double growth) {
    const double drift = glm::length(ray.drift);
    const double distance = glm::length(ray.across);
    const double a = (drift - std::abs(growth)) * (drift + std::abs(growth));
    const double b = glm::dot(ray.across, ray.drift) - growth * radius;
    const double c = (distance - radius) * (distance + radius);
    if (a == 0.0) {  // parallel to the side: one root, or none
        if (b == 0.0) return c <= 0.0 ? std::optional(Interval{}) : std::nullopt;
        const double root = -0.5 * c / b;
        return b > 0.0 ? Interval{-kInfinity, root} : Interval{root, kInfinity};
    }
    const double discriminant = b * b - a * c;
    // Steeper than the side it meets both nappes: then only rounding makes this negative.
    if (a > 0.0 && !(discriminant >= 0.0)) return std::nullopt;
    const double q = -(b + std::copysign(std::sqrt(std::max(discriminant, 0.0)), b));
    const double t0 = q / a;
    const double t1 = q != 0.0 ? c / q : t0;
    if (a > 0.0) return Interval{std::min(t0, t1), std::max(t0, t1)};
    return growth > 0.0 ? Interval{std::max(t0, t1), kInfinity}
                        : Interval{-kInfinity, std::min(t0, t1)};
}

}  // namespace

std::optional<ConeRoots> cone_roots(const Cone& cone, const ObjectRay& ray) {
    const ConeProfile profile = profile_of(cone);
    AxialRay axial = axial_ray(cone, profile, ray);
    std::optional<Interval> planes = between_planes(axial, profile.length);
    if (!planes) return std::nullopt;
    const double nearest = nearest_to_axis(axial, *planes);
    axial.advance(nearest);
    const double widest = std::max(cone.base_radius, cone.apex_radius);
    if (!(glm::dot(axial.across, axial.across) <= widest * widest)) return std::nullopt;
    *planes = {planes->from - nearest, planes->to - nearest};
    const auto side = within_side(axial, cone.base_radius + profile.widening * axial.height,
                                  profile.widening * axial.climb);
    if (!side) return std::nullopt;
    const Interval body{std::max(planes->from, side->from), std::min(planes->to, side->to)};
    if (!(body.from <= body.to) || !std::isfinite(body.from) || !std::isfinite(body.to))
        return std::nullopt;
    ConeRoots roots{profile, axial, {}, 0};
    const auto add = [&](double t, bool on_side, ConePart cap) {
        const double radius = cap == ConePart::base_cap ? cone.base_radius : cone.apex_radius;
        if (on_side || radius == 0.0) {
            roots.root[static_cast<std::size_t>(roots.count++)] = {t, ConePart::side};
        } else if (cone.capped) {
            roots.root[static_cast<std::size_t>(roots.count++)] = {t, cap};
        }
    };
    const bool upwards = axial.climb > 0.0;
    add(body.from, side->from >= planes->from, upwards ? ConePart::base_cap : ConePart::apex_cap);
    add(body.to, side->to <= planes->to, upwards ? ConePart::apex_cap : ConePart::base_cap);
    return roots;
}

glm::dvec3 cone_normal(const Cone& cone, const ConeRoots& roots, const ConeRoot& root) {
    const ConeProfile& profile = roots.profile;
    if (root.part == ConePart::base_cap) return -profile.axis;
    if (root.part == ConePart::apex_cap) return profile.axis;
    const glm::dvec3 across = roots.axial.across + root.after * roots.axial.drift;
    const double distance = glm::length(across);
    // At the tip of a cone the axis stands in for the normal.
    return distance > 0.0 ? across / distance - profile.widening * profile.axis
                          : std::copysign(1.0, cone.base_radius - cone.apex_radius) * profile.axis;
}

glm::dvec2 cone_uv(const Cone& cone, const ConeRoots& roots, const ConeRoot& root) {
    const AxialRay& axial = roots.axial;
    const AxisFrame frame = axis_frame(roots.profile.axis);
    const glm::dvec3 across = axial.across + root.after * axial.drift;
    const double angle = turn(glm::dot(across, frame.x), glm::dot(across, frame.z));
    if (root.part == ConePart::side) {
        const double height = axial.height + root.after * axial.climb;
        return {angle, std::clamp(height / roots.profile.length, 0.0, 1.0)};
    }
    const double radius = root.part == ConePart::base_cap ? cone.base_radius : cone.apex_radius;
    return {angle, std::min(glm::length(across) / radius, 1.0)};
}

ShapeHits intersect(const Cone& cone, const ObjectRay& ray) {
    const auto roots = cone_roots(cone, ray);
    ShapeHits hits;
    if (!roots) return hits;
    for (int i = 0; i < roots->count; ++i) {
        const ConeRoot& root = roots->root[static_cast<std::size_t>(i)];
        hits.hit[static_cast<std::size_t>(hits.count++)] = {
            roots->t(root), cone_uv(cone, *roots, root), cone_normal(cone, *roots, root),
            static_cast<std::uint32_t>(root.part)};
    }
    return hits;
}

}  // namespace raypick
