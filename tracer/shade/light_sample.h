// Lights as a lit point sees them: one point of the light at a time.
//
// The GLSL twin is in shaders/lights.glsl; it takes the centres of the cells.
#pragma once

#include "tracer/scene/light.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>

namespace raypick {

// From a lit point towards a point of a light, scene space.
struct LightSample {
    glm::vec3 direction{0.0f, 1.0f, 0.0f};                    // unit
    float distance = std::numeric_limits<float>::infinity();  // infinite for directional lights
    glm::vec3 colour{0.0f};  // that arrives if nothing is in the way; 0 beyond a spot's cone
};

// A light with all worked out that does not depend on the lit point.
struct PreparedLight {
    enum class Kind { point, directional, spot, sphere, rectangle };
    Kind kind = Kind::point;
    glm::dvec3 position{0.0};   // a sphere's centre, a rectangle's corner
    glm::dvec3 direction{0.0};  // unit, the way that light travels
    glm::dvec3 edge_u{0.0};
    glm::dvec3 edge_v{0.0};
    glm::vec3 colour{0.0f};
    Attenuation attenuation{};
    double inner_cosine = 1.0;
    double outer_cosine = 1.0;
    double radius = 0.0;
    int side = 1;  // side x side samples

    // samples * samples of an area light, 1 of the others.
    [[nodiscard]] int count() const { return side * side; }
    // All of its light comes from `position`.
    [[nodiscard]] bool is_a_point() const {
        return kind == Kind::point || kind == Kind::spot || (kind == Kind::sphere && side == 1);
    }
};
PreparedLight prepared(const Light& light);

// Sample `index` of count(). An area light of n x n samples is cut into n x n cells of equal area,
// the sample lies at random in cell (index % n, index / n), and its colour is 1 / n^2 of the
// light's. A single sample is at the centre; only others depend on `seed`, each on numbers of its
// own.
inline LightSample light_sample(const PreparedLight& light, const glm::dvec3& from, int index,
                                std::uint64_t seed);

// From a point of a light that sends `share` of the colour. A lit point that coincides with it has
// no direction to it and gets nothing.
inline LightSample light_towards(const glm::dvec3& position, const glm::dvec3& from,
                                 const glm::vec3& colour, const Attenuation& a, double share) {
    const glm::dvec3 offset = position - from;
    const double distance = glm::length(offset);
    if (!(distance > 0.0)) return {};
    // Divisions are what this takes time for.
    const bool falls_off = a.linear != 0.0 || a.quadratic != 0.0;
    const double weakening =
        falls_off ? a.constant + distance * (a.linear + distance * a.quadratic) : a.constant;
    const double falloff = weakening == 1.0 ? 1.0 : 1.0 / weakening;
    return {glm::vec3(offset * (1.0 / distance)), static_cast<float>(distance),
            glm::vec3(glm::dvec3(colour) * (share * falloff))};
}

// Of lights in a cone or with an area.
LightSample spread_light_sample(const PreparedLight& light, const glm::dvec3& from, int index,
                                std::uint64_t seed);

inline LightSample light_sample(const PreparedLight& light, const glm::dvec3& from, int index,
                                std::uint64_t seed) {
    if (light.kind == PreparedLight::Kind::point) {
        return light_towards(light.position, from, light.colour, light.attenuation, 1.0);
    }
    if (light.kind == PreparedLight::Kind::directional) {
        return {-glm::vec3(light.direction), std::numeric_limits<float>::infinity(), light.colour};
    }
    return spread_light_sample(light, from, index, seed);
}

// Two unit vectors perpendicular to a unit vector and to each other. Source: Duff et al., "Building
// an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct PlaneAxes {
    glm::dvec3 u{0.0};
    glm::dvec3 v{0.0};
};
PlaneAxes axes_across(const glm::dvec3& normal);

}  // namespace raypick
