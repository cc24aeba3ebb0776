#include "tracer/shade/light_sample.h"

#include "tracer/geometry/unit_disk.h"
#include "tracer/shade/random.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <variant>

namespace raypick {

namespace {

// How much of a spot's light leaves in a unit direction. With equal angles the edge is sharp.
double cone_share(const PreparedLight& spot, const glm::dvec3& direction) {
    const double cosine = glm::dot(spot.direction, direction);
    if (cosine >= spot.inner_cosine) return 1.0;
    if (!(cosine > spot.outer_cosine)) return 0.0;
    const double step = (cosine - spot.outer_cosine) / (spot.inner_cosine - spot.outer_cosine);
    return step * step;
}

// Where in the unit square sample `index` of n x n lies.
glm::dvec2 stratified(int index, int n, std::uint64_t seed) {
    if (n == 1) return glm::dvec2(0.5);
    RandomSequence random(seed);
    random.skip(2 * static_cast<std::uint64_t>(index));
    const auto u = static_cast<double>(random.next());
    const auto v = static_cast<double>(random.next());
    const glm::dvec2 corner(index % n, index / n);
    return (corner + glm::dvec2(u, v)) / static_cast<double>(n);
}

LightSample from_spot(const PreparedLight& light, const glm::dvec3& from) {
    const glm::dvec3 offset = from - light.position;
    const double distance = glm::length(offset);
    if (!(distance > 0.0)) return {};
    return light_towards(light.position, from, light.colour, light.attenuation,
                         cone_share(light, offset / distance));
}

LightSample from_sphere(const PreparedLight& light, const glm::dvec3& from, const glm::dvec2& at) {
    const glm::dvec3 offset = light.position - from;
    const double distance = glm::length(offset);
    if (!(distance > 0.0)) return {};
    const PlaneAxes axes = axes_across(offset / distance);
    const glm::dvec2 disk = light.radius * disk_from_square(at);
    return light_towards(light.position + disk.x * axes.u + disk.y * axes.v, from, light.colour,
                         light.attenuation, 1.0 / light.count());
}

struct Prepare {
    PreparedLight operator()(const PointLight& light) const {
        return of(PreparedLight::Kind::point, light.position, light.colour, light.attenuation);
    }

    PreparedLight operator()(const DirectionalLight& light) const {
        PreparedLight sun = of(PreparedLight::Kind::directional, {}, light.colour, {});
        sun.direction = glm::normalize(light.direction);
        return sun;
    }

    PreparedLight operator()(const SpotLight& light) const {
        PreparedLight spot =
            of(PreparedLight::Kind::spot, light.position, light.colour, light.attenuation);
        spot.direction = glm::normalize(light.direction);
        spot.inner_cosine = std::cos(glm::radians(light.inner_degrees));
        spot.outer_cosine = std::cos(glm::radians(light.outer_degrees));
        return spot;
    }

    PreparedLight operator()(const SphereLight& light) const {
        PreparedLight sphere =
            of(PreparedLight::Kind::sphere, light.centre, light.colour, light.attenuation);
        sphere.radius = light.radius;
        sphere.side = light.samples;
        return sphere;
    }

    PreparedLight operator()(const RectangleLight& light) const {
        PreparedLight rectangle =
            of(PreparedLight::Kind::rectangle, light.corner, light.colour, light.attenuation);
        rectangle.edge_u = light.edge_u;
        rectangle.edge_v = light.edge_v;
        rectangle.side = light.samples;
        return rectangle;
    }

    static PreparedLight of(PreparedLight::Kind kind, const glm::dvec3& position,
                            const glm::vec3& colour, const Attenuation& attenuation) {
        PreparedLight light;
        light.kind = kind;
        light.position = position;
        light.colour = colour;
        light.attenuation = attenuation;
        return light;
    }
};

}  // namespace

PreparedLight prepared(const Light& light) {
    return std::visit(Prepare{}, light);
}

LightSample spread_light_sample(const PreparedLight& light, const glm::dvec3& from, int index,
                                std::uint64_t seed) {
    switch (light.kind) {
        case PreparedLight::Kind::point:
        case PreparedLight::Kind::directional:
            return light_sample(light, from, index, seed);
        case PreparedLight::Kind::spot:
            return from_spot(light, from);
        case PreparedLight::Kind::sphere:
            return from_sphere(light, from, stratified(index, light.side, seed));
        case PreparedLight::Kind::rectangle: {
            const glm::dvec2 at = stratified(index, light.side, seed);
            return light_towards(light.position + at.x * light.edge_u + at.y * light.edge_v, from,
                                 light.colour, light.attenuation, 1.0 / light.count());
        }
    }
    return {};
}

PlaneAxes axes_across(const glm::dvec3& normal) {
    const double sign = normal.z >= 0.0 ? 1.0 : -1.0;
    const double a = -1.0 / (sign + normal.z);
    const double b = normal.x * normal.y * a;
    return {{1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
            {b, sign + normal.y * normal.y * a, -normal.y}};
}

}  // namespace raypick
