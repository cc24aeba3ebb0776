// One ray on its way through one object: which of its hits count.
#pragma once

#include "tracer/accel/accel_state.h"
#include "tracer/accel/cut_out.h"
#include "tracer/accel/searches.h"
#include "tracer/geometry/cone.h"
#include "tracer/geometry/ray.h"
#include "tracer/geometry/rectangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace raypick {

inline bool inside_clip_planes(const Ray& ray, float t, std::span<const ClipPlane> planes) {
    return std::all_of(planes.begin(), planes.end(), [&](const ClipPlane& plane) {
        return glm::dot(plane.normal, ray.at(t)) + plane.d >= 0.0f;
    });
}

inline bool shows(Sides sides, bool front_face) {
    if (sides == Sides::both) return true;
    return front_face == (sides == Sides::front_only);
}

// False for what is no ray: a NaN, an infinity, no direction, an empty interval.
inline bool usable(const Ray& ray) {
    const glm::vec3 sum = ray.origin + ray.direction;
    const bool finite = std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
    return finite && ray.direction != glm::vec3(0.0f) && ray.t_min < ray.t_max;
}

inline ObjectRay object_ray(const Instance& instance, const Ray& ray) {
    if (instance.identity) return {glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
    return {instance.object_from_world.point(glm::dvec3(ray.origin)),
            instance.object_from_world.vector(glm::dvec3(ray.direction))};
}

struct Passage {
    const Scene& scene;
    const Object& object;
    const Instance& instance;
    const Ray& ray;
    const RayQuery& query;
    ObjectRay local;

    [[nodiscard]] bool admits(const Hit& hit) const {
        if (!shows(object.sides, hit.front_face) || !shows(query.sides, hit.front_face)) {
            return false;
        }
        if (!inside_clip_planes(ray, hit.t, query.clip_planes)) return false;
        if (instance.holes && is_cut_out(scene, object, hit)) return false;
        return query.accept(hit);
    }
    [[nodiscard]] bool in_range(float t, float limit) const {
        return t > ray.t_min && t < ray.t_max && t <= limit;
    }
};

// Whether a hit's uv matters to anyone.
template <typename Search>
bool wants_uv(const Passage& passage) {
    return (kKeepsHits<Search> && passage.query.uv) || passage.instance.holes ||
           passage.query.accept;
}

// Offers to the search what a shape's intersection found; true: stop. `element` is the shape's
// number in a set: that is then the primitive, whatever side of the shape was hit.
template <typename Search>
bool offer(const Passage& passage, const ShapeHits& hits, std::optional<std::uint32_t> element,
           Search& search) {
    for (int i = 0; i < hits.count; ++i) {
        const ShapeHit& found = hits.hit[static_cast<std::size_t>(i)];
        const auto t = static_cast<float>(found.t);
        if (!passage.in_range(t, search.limit())) continue;
        const Hit hit{passage.object.id, element.value_or(found.primitive), t, glm::vec2(found.uv),
                      glm::dot(found.normal, passage.local.direction) < 0.0};
        if (passage.admits(hit) && search.offer(hit)) return true;
    }
    return false;
}

// The same of a sphere, whose uv is worked out for hits that count only.
template <typename Search>
bool offer_sphere(const Passage& passage, const Sphere& sphere, std::uint32_t element,
                  Search& search) {
    const auto roots = sphere_roots(sphere, passage.local);
    if (!roots) return false;
    for (const double root : roots->t) {
        const auto t = static_cast<float>(root);
        if (!passage.in_range(t, search.limit())) continue;
        const glm::dvec3 normal =
            (passage.local.origin + root * passage.local.direction - sphere.centre) / sphere.radius;
        Hit hit{passage.object.id, element, t, glm::vec2(0.0f),
                glm::dot(normal, passage.local.direction) < 0.0};
        if (!shows(passage.object.sides, hit.front_face)) continue;
        if (wants_uv<Search>(passage)) {
            hit.uv = glm::vec2(sphere_hit(sphere, passage.local, root).uv);
        }
        if (passage.admits(hit) && search.offer(hit)) return true;
    }
    return false;
}

// The same of a cone.
template <typename Search>
bool offer_cone(const Passage& passage, const Cone& cone, std::uint32_t element, Search& search) {
    const auto roots = cone_roots(cone, passage.local);
    if (!roots) return false;
    for (int i = 0; i < roots->count; ++i) {
        const ConeRoot& root = roots->root[static_cast<std::size_t>(i)];
        const auto t = static_cast<float>(roots->t(root));
        if (!passage.in_range(t, search.limit())) continue;
        Hit hit{passage.object.id, element, t, glm::vec2(0.0f),
                glm::dot(cone_normal(cone, *roots, root), passage.local.direction) < 0.0};
        if (!shows(passage.object.sides, hit.front_face)) continue;
        if (wants_uv<Search>(passage)) hit.uv = glm::vec2(cone_uv(cone, *roots, root));
        if (passage.admits(hit) && search.offer(hit)) return true;
    }
    return false;
}

// The same of a rectangle.
template <typename Search>
bool offer_rectangle(const Passage& passage, const Rectangle& rectangle, Search& search) {
    const auto root = meet_plane_of(rectangle, passage.local);
    if (!root) return false;
    const auto t = static_cast<float>(*root);
    if (!passage.in_range(t, search.limit())) return false;
    if (!passes_within(rectangle, passage.local)) return false;
    Hit hit{passage.object.id, 0, t, glm::vec2(0.0f),
            glm::dot(rectangle_normal(rectangle), passage.local.direction) < 0.0};
    if (!shows(passage.object.sides, hit.front_face)) return false;
    ShapeHit exact;
    if (wants_uv<Search>(passage) && meet_within(rectangle, passage.local, exact)) {
        hit.uv = glm::vec2(exact.uv);
    }
    return passage.admits(hit) && search.offer(hit);
}

}  // namespace raypick
