// The truncated cone, as the convex body between its caps: the part of the ray between the two
// planes and the part within the side are intervals, and the body is where they overlap. So a ray
// from the inside of a capped cone always meets it.
#include "tracer/geometry/axis_frame.h"
#include "tracer/geometry/shapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace raypick {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kSide = 0;
constexpr std::uint32_t kBaseCap = 1;
constexpr std::uint32_t kApexCap = 2;

struct Interval {
    double from = -kInfinity;
    double to = kInfinity;
};

// The cone along its axis: the radius at height h above the base is base_radius + widening h.
struct Profile {
    glm::dvec3 axis{0.0, 1.0, 0.0};
    double length = 1.0;
    double widening = 0.0;
};

Profile profile_of(const Cone& cone) {
    const glm::dvec3 axis = cone.apex - cone.base;
    const double length = glm::length(axis);
    return {axis / length, length, (cone.apex_radius - cone.base_radius) / length};
}

// A ray split along and across the axis, seen from the base's centre; its parameter is counted from
// `start` of the original ray's t.
struct AxialRay {
    double start = 0.0;
    double height = 0.0;
    double climb = 0.0;
    glm::dvec3 across{0.0};
    glm::dvec3 drift{0.0};

    void advance(double t) {
        start += t;
        height += t * climb;
        across += t * drift;
    }
};

// Counted from the point nearest to the cone's middle, so that far origins cost no precision.
AxialRay axial_ray(const Cone& cone, const Profile& profile, const ObjectRay& ray) {
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

ShapeHit side_hit(const Cone& cone, const Profile& profile, const AxialRay& ray, double t) {
    const AxisFrame frame = axis_frame(profile.axis);
    const glm::dvec3 across = ray.across + t * ray.drift;
    const double distance = glm::length(across);
    ShapeHit hit;
    hit.t = ray.start + t;
    hit.primitive = kSide;
    // At the tip of a cone the axis stands in for the normal.
    hit.normal = distance > 0.0
                     ? across / distance - profile.widening * profile.axis
                     : std::copysign(1.0, cone.base_radius - cone.apex_radius) * profile.axis;
    hit.uv = {turn(glm::dot(across, frame.x), glm::dot(across, frame.z)),
              std::clamp((ray.height + t * ray.climb) / profile.length, 0.0, 1.0)};
    return hit;
}

ShapeHit cap_hit(const Cone& cone, const Profile& profile, const AxialRay& ray, double t,
                 std::uint32_t cap) {
    const AxisFrame frame = axis_frame(profile.axis);
    const glm::dvec3 across = ray.across + t * ray.drift;
    const double radius = cap == kBaseCap ? cone.base_radius : cone.apex_radius;
    ShapeHit hit;
    hit.t = ray.start + t;
    hit.primitive = cap;
    hit.normal = cap == kBaseCap ? -profile.axis : profile.axis;
    hit.uv = {turn(glm::dot(across, frame.x), glm::dot(across, frame.z)),
              std::min(glm::length(across) / radius, 1.0)};
    return hit;
}

}  // namespace

ShapeHits intersect(const Cone& cone, const ObjectRay& ray, double from, double to) {
    const Profile profile = profile_of(cone);
    AxialRay axial = axial_ray(cone, profile, ray);
    std::optional<Interval> planes = between_planes(axial, profile.length);
    if (!planes) return {};
    const double nearest = nearest_to_axis(axial, *planes);
    axial.advance(nearest);
    const double widest = std::max(cone.base_radius, cone.apex_radius);
    if (!(glm::dot(axial.across, axial.across) <= widest * widest)) return {};
    *planes = {planes->from - nearest, planes->to - nearest};
    const auto side = within_side(axial, cone.base_radius + profile.widening * axial.height,
                                  profile.widening * axial.climb);
    if (!side) return {};
    const Interval body{std::max(planes->from, side->from), std::min(planes->to, side->to)};
    if (!(body.from <= body.to) || !std::isfinite(body.from) || !std::isfinite(body.to)) return {};

    ShapeHits hits;
    const auto add = [&](double t, bool on_side, std::uint32_t cap) {
        if (axial.start + t < from || axial.start + t > to) return;
        const double radius = cap == kBaseCap ? cone.base_radius : cone.apex_radius;
        auto& hit = hits.hit[static_cast<std::size_t>(hits.count)];
        if (on_side || radius == 0.0) {
            hit = side_hit(cone, profile, axial, t);
        } else if (cone.capped) {
            hit = cap_hit(cone, profile, axial, t, cap);
        } else {
            return;
        }
        ++hits.count;
    };
    const bool upwards = axial.climb > 0.0;
    add(body.from, side->from >= planes->from, upwards ? kBaseCap : kApexCap);
    add(body.to, side->to <= planes->to, upwards ? kApexCap : kBaseCap);
    return hits;
}

}  // namespace raypick
