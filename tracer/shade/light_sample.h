// Lights as a lit point sees them: one point of the light at a time.
//
// The GLSL twin is in shaders/lights.glsl; it takes the centres of the cells.
#pragma once

#include "tracer/scene/light.h"

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
};
PreparedLight prepared(const Light& light);

// Sample `index` of count(). An area light of n x n samples is cut into n x n cells of equal area,
// the sample lies at random in cell (index % n, index / n), and its colour is 1 / n^2 of the
// light's. A single sample is at the centre; only others depend on `seed`, each on numbers of its
// own.
LightSample light_sample(const PreparedLight& light, const glm::dvec3& from, int index,
                         std::uint64_t seed);

// Two unit vectors perpendicular to a unit vector and to each other. Source: Duff et al., "Building
// an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct PlaneAxes {
    glm::dvec3 u{0.0};
    glm::dvec3 v{0.0};
};
PlaneAxes axes_across(const glm::dvec3& normal);

}  // namespace raypick
