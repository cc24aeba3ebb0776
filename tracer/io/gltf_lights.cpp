#include "tracer/io/gltf_lights.h"

#include "tracer/scene/limits.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

namespace raypick {

namespace {

constexpr double kHalfPi = 1.5707963267948966;
constexpr Attenuation kInverseSquare{0.0, 0.0, 1.0};

glm::vec3 light_colour(const JsonValue& json) {
    constexpr NumberRule kIntensity{0.0, 1e18, true, "a number, 0 or more"};
    double intensity = 1.0;
    if (const auto value = json.find("intensity")) intensity = value->number(kIntensity);
    glm::dvec3 colour(1.0);
    if (const auto rgb = json.find("color")) {
        const std::vector<JsonValue> numbers = rgb->elements(3, "three numbers");
        for (int i = 0; i < 3; ++i)
            colour[i] = numbers[static_cast<std::size_t>(i)].number(kIntensity);
    }
    const glm::vec3 emitted(glm::min(colour * intensity, glm::dvec3(1e30)));
    return emitted;
}

// Half angles of the cone, in degrees.
void read_cone(const JsonValue& json, SpotLight& light) {
    constexpr NumberRule kAngle{0.0, kHalfPi + 1e-6, true, "an angle between 0 and pi / 2"};
    double inner = 0.0;
    double outer = 0.5 * kHalfPi;
    if (const auto cone = json.find("spot")) {
        if (const auto value = cone->find("innerConeAngle")) inner = value->number(kAngle);
        if (const auto value = cone->find("outerConeAngle")) outer = value->number(kAngle);
    }
    light.outer_degrees = std::min(90.0, glm::degrees(outer));
    light.inner_degrees = std::min(light.outer_degrees, glm::degrees(inner));
}

// The greatest channel of what arrives at a point, distances below `least` counted as that.
double irradiance(const Light& light, const glm::dvec3& point, double least) {
    const auto greatest = [](const glm::vec3& c) {
        return static_cast<double>(std::max({c.x, c.y, c.z}));
    };
    const auto faded = [&](const glm::vec3& colour, const glm::dvec3& position) {
        const double distance = std::max(glm::distance(position, point), least);
        return distance > 0.0 ? greatest(colour) / (distance * distance) : greatest(colour);
    };
    if (const auto* bulb = std::get_if<PointLight>(&light)) {
        return faded(bulb->colour, bulb->position);
    }
    if (const auto* spot = std::get_if<SpotLight>(&light)) {
        return faded(spot->colour, spot->position);
    }
    return std::visit([&](const auto& other) { return greatest(other.colour); }, light);
}

// Divides the light. What is far away may get brighter than colours may be: then it fades less.
template <typename Kind>
void expose(Kind& light, double brightest) {
    glm::dvec3 colour = glm::dvec3(light.colour) / brightest;
    const double excess = std::max({colour.x, colour.y, colour.z}) / kMostLight;
    if (excess > 1.0) {
        colour /= excess;
        if constexpr (requires { light.attenuation; }) {
            light.attenuation.quadratic =
                std::max(light.attenuation.quadratic / excess, kLeastAttenuation);
        }
    }
    light.colour = glm::vec3(colour);
}

}  // namespace

std::optional<Light> read_gltf_light(const GltfDocument& document, const JsonValue& reference,
                                     const JsonValue& node, const Transform& world) {
    const std::uint64_t index = whole_number(reference);
    const JsonValue file_lights =
        document.root().need("extensions").need("KHR_lights_punctual").need("lights");
    const std::vector<JsonValue> lights = file_lights.elements();
    if (index >= lights.size()) reference.fail(fmt::format("light {} does not exist", index));
    const JsonValue& json = lights[static_cast<std::size_t>(index)];
    std::string name = name_of(node).empty() ? name_of(json) : name_of(node);
    if (name.empty()) name = fmt::format("light{}", index);
    const std::string type = json.need("type").text();
    const glm::vec3 colour = light_colour(json);
    const glm::dvec3 direction = world.vector({0.0, 0.0, -1.0});
    if (type == "point") {
        return PointLight{std::move(name), world.translation, colour, kInverseSquare};
    }
    if (type != "directional" && type != "spot") {
        json.need("type").refuse(R"("directional", "point" or "spot")");
    }
    if (direction == glm::dvec3(0.0)) return std::nullopt;
    if (type == "directional") return DirectionalLight{std::move(name), direction, colour};
    SpotLight spot;
    spot.name = std::move(name);
    spot.position = world.translation;
    spot.direction = direction;
    spot.colour = colour;
    spot.attenuation = kInverseSquare;
    read_cone(json, spot);
    return spot;
}

void expose_gltf_lights(Scene& scene) {
    const Bounds bounds = scene_bounds(scene);
    glm::dvec3 centre(0.0);
    double least = 0.0;
    if (!bounds.empty()) {
        centre = glm::dvec3(bounds.min) + 0.5 * glm::dvec3(bounds.extent());
        least = 0.25 * glm::length(glm::dvec3(bounds.extent()));
    }
    double brightest = 0.0;
    for (const Light& light : scene.lights)
        brightest = std::max(brightest, irradiance(light, centre, least));
    if (!(brightest > 0.0) || !std::isfinite(brightest)) return;
    for (Light& light : scene.lights)
        std::visit([&](auto& kind) { expose(kind, brightest); }, light);
}

}  // namespace raypick
