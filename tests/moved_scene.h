// A scene under a similarity: turned, scaled and moved with everything that belongs to it.
#pragma once

#include "tracer/scene/scene.h"

#include <glm/mat3x3.hpp>

#include <utility>
#include <variant>

namespace raypick {

// Scales first, then turns, then moves.
struct Similarity {
    double scale = 1.0;
    Transform turn{};
    glm::dvec3 offset{0.0};

    [[nodiscard]] glm::dvec3 direction(const glm::dvec3& v) const { return turn.vector(v); }
    [[nodiscard]] glm::dvec3 vector(const glm::dvec3& v) const { return scale * direction(v); }
    [[nodiscard]] glm::dvec3 point(const glm::dvec3& p) const { return vector(p) + offset; }
};

inline Attenuation moved(const Attenuation& a, double scale) {
    return {a.constant, a.linear / scale, a.quadratic / (scale * scale)};
}

inline Light moved(Light light, const Similarity& by) {
    if (auto* point = std::get_if<PointLight>(&light)) {
        point->position = by.point(point->position);
        point->attenuation = moved(point->attenuation, by.scale);
    } else if (auto* sun = std::get_if<DirectionalLight>(&light)) {
        sun->direction = by.direction(sun->direction);
    } else if (auto* spot = std::get_if<SpotLight>(&light)) {
        spot->position = by.point(spot->position);
        spot->direction = by.direction(spot->direction);
        spot->attenuation = moved(spot->attenuation, by.scale);
    } else if (auto* sphere = std::get_if<SphereLight>(&light)) {
        sphere->centre = by.point(sphere->centre);
        sphere->radius *= by.scale;
        sphere->attenuation = moved(sphere->attenuation, by.scale);
    } else if (auto* rectangle = std::get_if<RectangleLight>(&light)) {
        rectangle->corner = by.point(rectangle->corner);
        rectangle->edge_u = by.vector(rectangle->edge_u);
        rectangle->edge_v = by.vector(rectangle->edge_v);
        rectangle->attenuation = moved(rectangle->attenuation, by.scale);
    }
    return light;
}

inline Camera moved(Camera camera, const Similarity& by) {
    camera.eye = by.point(camera.eye);
    camera.at = by.point(camera.at);
    camera.up = by.direction(camera.up);
    camera.near *= by.scale;
    camera.height *= by.scale;
    return camera;
}

inline Environment moved(Environment environment, const Similarity& by) {
    if (auto* gradient = std::get_if<GradientSky>(&environment)) {
        gradient->up = by.direction(gradient->up);
    } else if (auto* image = std::get_if<ImageSky>(&environment)) {
        image->up = by.direction(image->up);
        image->forward = by.direction(image->forward);
    }
    return environment;
}

// The scene's origin is chosen anew.
inline Scene moved(Scene scene, const Similarity& by) {
    const glm::dmat3 linear = by.scale * by.turn.linear;
    for (Object& object : scene.objects)
        object.world_from_object = Transform{linear, by.offset} * object.world_from_object;
    for (Light& light : scene.lights)
        light = moved(std::move(light), by);
    for (NamedCamera& named : scene.cameras)
        named.camera = moved(named.camera, by);
    for (Material& material : scene.materials)
        material.absorption /= static_cast<float>(by.scale);
    scene.environment = moved(std::move(scene.environment), by);
    choose_origin(scene);
    return scene;
}

}  // namespace raypick
