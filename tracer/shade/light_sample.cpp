#include "tracer/shade/light_sample.h"

#include "tracer/geometry/unit_disk.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <cmath>

namespace raypick {

namespace {

double falloff(const Attenuation& a, double distance) {
    return 1.0 / (a.constant + distance * (a.linear + distance * a.quadratic));
}

// A point of a light that sends `share` of the colour. A lit point that coincides with the light
// has no direction to it and gets nothing.
LightSample towards(const glm::dvec3& position, const glm::dvec3& from, const glm::vec3& colour,
                    const Attenuation& attenuation, double share) {
    const glm::dvec3 offset = position - from;
    const double distance = glm::length(offset);
    if (!(distance > 0.0)) return {};
    return {glm::vec3(offset / distance), static_cast<float>(distance),
            glm::vec3(glm::dvec3(colour) * (share * falloff(attenuation, distance)))};
}

// How much of a spot's light leaves in a unit direction. With equal angles the edge is sharp.
double cone_share(const SpotLight& spot, const glm::dvec3& direction) {
    const double cosine = glm::dot(glm::normalize(spot.direction), direction);
    const double inner = std::cos(glm::radians(spot.inner_degrees));
    const double outer = std::cos(glm::radians(spot.outer_degrees));
    if (cosine >= inner) return 1.0;
    if (!(cosine > outer)) return 0.0;
    const double step = (cosine - outer) / (inner - outer);
    return step * step;
}

// Where in the unit square sample `index` of n x n lies.
glm::dvec2 stratified(int index, int n, RandomSequence& random) {
    if (n == 1) return glm::dvec2(0.5);
    const auto u = static_cast<double>(random.next());
    const auto v = static_cast<double>(random.next());
    const glm::dvec2 corner(index % n, index / n);
    return (corner + glm::dvec2(u, v)) / static_cast<double>(n);
}

struct SampleOf {
    const glm::dvec3& from;
    int index;
    RandomSequence& random;

    LightSample operator()(const PointLight& light) const {
        return towards(light.position, from, light.colour, light.attenuation, 1.0);
    }

    LightSample operator()(const DirectionalLight& light) const {
        return {-glm::vec3(glm::normalize(light.direction)), std::numeric_limits<float>::infinity(),
                light.colour};
    }

    LightSample operator()(const SpotLight& light) const {
        const glm::dvec3 offset = from - light.position;
        const double distance = glm::length(offset);
        if (!(distance > 0.0)) return {};
        return towards(light.position, from, light.colour, light.attenuation,
                       cone_share(light, offset / distance));
    }

    LightSample operator()(const SphereLight& light) const {
        const glm::dvec3 offset = light.centre - from;
        const double distance = glm::length(offset);
        if (!(distance > 0.0)) return {};
        const PlaneAxes axes = axes_across(offset / distance);
        const glm::dvec2 disk =
            light.radius * disk_from_square(stratified(index, light.samples, random));
        return towards(light.centre + disk.x * axes.u + disk.y * axes.v, from, light.colour,
                       light.attenuation, share(light.samples));
    }

    LightSample operator()(const RectangleLight& light) const {
        const glm::dvec2 at = stratified(index, light.samples, random);
        return towards(light.corner + at.x * light.edge_u + at.y * light.edge_v, from, light.colour,
                       light.attenuation, share(light.samples));
    }

    static double share(int samples) { return 1.0 / (samples * samples); }
};

}  // namespace

int sample_count(const Light& light) {
    if (const auto* sphere = std::get_if<SphereLight>(&light)) {
        return sphere->samples * sphere->samples;
    }
    if (const auto* rectangle = std::get_if<RectangleLight>(&light)) {
        return rectangle->samples * rectangle->samples;
    }
    return 1;
}

LightSample light_sample(const Light& light, const glm::dvec3& from, int index,
                         RandomSequence& random) {
    return std::visit(SampleOf{from, index, random}, light);
}

PlaneAxes axes_across(const glm::dvec3& normal) {
    const double sign = normal.z >= 0.0 ? 1.0 : -1.0;
    const double a = -1.0 / (sign + normal.z);
    const double b = normal.x * normal.y * a;
    return {{1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
            {b, sign + normal.y * normal.y * a, -normal.y}};
}

}  // namespace raypick
