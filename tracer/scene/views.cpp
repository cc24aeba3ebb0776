#include "tracer/scene/scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

constexpr double kDefaultFovy = 45.0;

// From the scene to the eye where y is up: front, right and above.
constexpr glm::dvec3 kDefaultEyeSide{0.6, 0.45, 1.0};

// The smallest turn that takes the y axis to `up`.
Transform turn_y_to(const glm::dvec3& up) {
    const glm::dvec3 y{0.0, 1.0, 0.0};
    const glm::dvec3 axis = glm::cross(y, up);
    const double sine = glm::length(axis);
    const double cosine = glm::dot(y, up);
    if (sine == 0.0) return cosine < 0.0 ? rotate(180.0, {1.0, 0.0, 0.0}) : Transform{};
    return rotate(std::atan2(sine, cosine) * 180.0 / std::acos(-1.0), axis);
}

// The world form of an object that is an infinite plane: unit normal and the point nearest to the
// origin.
struct WorldPlane {
    glm::dvec3 normal{0.0, 1.0, 0.0};
    glm::dvec3 point{0.0};
};

std::optional<WorldPlane> first_visible_plane(const Scene& scene) {
    for (const Object& object : scene.objects) {
        const Plane* plane = std::get_if<Plane>(&object.shape);
        if (plane == nullptr || object.mask == 0) continue;
        const std::optional<Transform> object_from_world = inverse(object.world_from_object);
        if (!object_from_world) continue;
        const glm::dvec3 on_plane =
            -plane->d / glm::dot(plane->normal, plane->normal) * plane->normal;
        const glm::dvec3 normal = world_normal(*object_from_world, plane->normal);
        const glm::dvec3 world_point = object.world_from_object.point(on_plane);
        return WorldPlane{normal, glm::dot(normal, world_point) * normal};
    }
    return std::nullopt;
}

// Brings the eye to the plane's outside, well above its horizon.
glm::dvec3 above_plane(const glm::dvec3& eye_side, const glm::dvec3& normal) {
    const glm::dvec3 unit = glm::normalize(eye_side);
    const double height = glm::dot(unit, normal);
    return unit + (std::max(std::abs(height), 0.4) - height) * normal;
}

// Frames the scene from the default side, with this camera's up, fovy and projection.
Camera framing_camera(const Scene& scene, const Bounds& bounds, ImageSize size,
                      const Camera& like) {
    Camera camera = like;
    camera.eye = turn_y_to(like.up).vector(kDefaultEyeSide);
    camera.at = glm::dvec3(0.0);
    if (!bounds.empty()) return frame_bounds(bounds, camera, size.aspect());

    const std::optional<WorldPlane> plane = first_visible_plane(scene);
    if (!plane) return frame_bounds(bounds, camera, size.aspect());
    Bounds around;
    around.extend(glm::vec3(plane->point - 0.5));
    around.extend(glm::vec3(plane->point + 0.5));
    camera.eye = above_plane(camera.eye, plane->normal);
    return frame_bounds(around, camera, size.aspect());
}

// The file's camera by another projection, if another is wanted.
Camera projected(const Camera& camera, Projection projection, const Bounds& bounds) {
    if (camera.projection == projection) return camera;
    return projection == Projection::orthographic ? orthographic_view(camera, bounds)
                                                  : perspective_view(camera);
}

}  // namespace

PointLight headlight(const Camera& camera) {
    return {"headlight", camera.eye, glm::vec3(1.0f)};
}

Camera default_camera(const Scene& scene, ImageSize size, const glm::dvec3& up) {
    const Bounds bounds = scene_bounds(scene);
    Camera like;
    like.up = up;
    like.fovy = kDefaultFovy;
    Camera camera = scene.cameras.empty() ? framing_camera(scene, bounds, size, like)
                                          : scene.cameras.front().camera;
    camera.near = near_for_bounds(camera, bounds);
    return camera;
}

Camera choose_camera(const Scene& scene, ImageSize size, const CameraOverride& wanted) {
    const bool from_file = !scene.cameras.empty();
    Camera camera = from_file ? scene.cameras.front().camera : Camera{};
    if (wanted.up) camera.up = *wanted.up;
    camera.fovy = wanted.fovy.value_or(from_file ? camera.fovy : kDefaultFovy);
    const Projection projection =
        wanted.projection.value_or(wanted.fovy ? Projection::perspective : camera.projection);
    if (wanted.height) camera.height = *wanted.height;
    // Before any of it is used to frame the scene.
    check_camera(camera);
    const Bounds bounds = scene_bounds(scene);
    if (!from_file) {
        camera.projection = projection;
        camera = framing_camera(scene, bounds, size, camera);
    }
    if (wanted.at) camera.at = *wanted.at - scene.origin;
    if (wanted.eye) camera.eye = *wanted.eye - scene.origin;
    check_camera(camera);
    camera = projected(camera, projection, bounds);
    if (wanted.eye) camera.eye = *wanted.eye - scene.origin;
    if (wanted.height) camera.height = *wanted.height;
    camera.near = near_for_bounds(camera, bounds);
    return camera;
}

std::vector<Light> effective_lights(const Scene& scene, const Camera& camera) {
    if (!scene.lights.empty()) return scene.lights;
    return {headlight(camera)};
}

}  // namespace raypick
