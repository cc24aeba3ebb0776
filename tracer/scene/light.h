// Light sources. Colours are linear RGB and may exceed 1.
#pragma once

#include "tracer/geometry/camera.h"

#include <glm/vec3.hpp>

#include <string>
#include <variant>

namespace raypick {

// The notes' fall-off at distance d: 1 / (constant + linear d + quadratic d^2).
struct Attenuation {
    double constant = 1.0;
    double linear = 0.0;
    double quadratic = 0.0;

    friend bool operator==(const Attenuation&, const Attenuation&) = default;
};

// Below, positions and directions are in scene space; directions have any length but 0.

struct PointLight {
    std::string name;
    glm::dvec3 position{0.0};
    glm::vec3 colour{1.0f};
    Attenuation attenuation{};
};

struct DirectionalLight {
    std::string name;
    glm::dvec3 direction{0.0, -1.0, 0.0};  // the way the light travels
    glm::vec3 colour{1.0f};
};

// A point light that shines in a cone: fully within inner_degrees of its direction, not at all
// beyond outer_degrees, in between by a smooth step of the angle's cosine, as glTF has it:
// clamp((cos angle - cos outer) / (cos inner - cos outer), 0, 1)^2.
struct SpotLight {
    std::string name;
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0.0, -1.0, 0.0};
    glm::vec3 colour{1.0f};
    Attenuation attenuation{};
    double inner_degrees = 20.0;  // half angles, 0 <= inner <= outer <= 90
    double outer_degrees = 30.0;
};

// Area lights act as point lights of their colour spread evenly over them: samples x samples
// stratified points (1: the centre), each with its own shadow ray and its share of the colour.
// They are not seen themselves; place an emissive surface where that is wanted.

// Spread over the disk of this radius that faces the lit point.
struct SphereLight {
    std::string name;
    glm::dvec3 centre{0.0};
    double radius = 0.5;
    glm::vec3 colour{1.0f};
    Attenuation attenuation{};
    int samples = 4;  // 1..64
};

struct RectangleLight {
    std::string name;
    glm::dvec3 corner{0.0};
    glm::dvec3 edge_u{1.0, 0.0, 0.0};
    glm::dvec3 edge_v{0.0, 0.0, 1.0};
    glm::vec3 colour{1.0f};
    Attenuation attenuation{};
    int samples = 4;  // 1..64
};

using Light = std::variant<PointLight, DirectionalLight, SpotLight, SphereLight, RectangleLight>;

// What a scene without lights is seen by: a lamp at the camera's eye.
PointLight headlight(const Camera& camera);

}  // namespace raypick
