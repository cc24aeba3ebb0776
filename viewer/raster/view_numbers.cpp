#include "viewer/raster/view_numbers.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace raypick {

ViewNumbers view_numbers(const Camera& camera, ImageSize size) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dmat4 clip = clip_from_eye(camera, size);
    const double pixel_width = 2.0 / clip[0][0] / size.cols;
    const double pixel_height = 2.0 / clip[1][1] / size.rows;
    ViewNumbers view;
    view.eye = glm::dvec3(glm::vec3(camera.eye));
    view.clip_from_scene =
        glm::transpose(glm::dmat3(clip[0][0] * frame.vx, clip[1][1] * frame.vy, -frame.vz));
    view.near = camera.near;
    view.pixel_angle = pixel_height;
    view.block.right = glm::vec4(glm::vec3(pixel_width * frame.vx), 0.0f);
    view.block.up = glm::vec4(glm::vec3(pixel_height * frame.vy), 0.0f);
    view.block.back = glm::vec4(glm::vec3(frame.vz), static_cast<float>(camera.near));
    view.block.size = glm::vec4(size.cols, size.rows, 0, 0);
    return view;
}

bool may_be_seen(const ViewNumbers& view, const Bounds& bounds) {
    if (bounds.empty()) return true;
    bool outside[5] = {true, true, true, true, true};
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? bounds.max.x : bounds.min.x,
                                (i & 2) != 0 ? bounds.max.y : bounds.min.y,
                                (i & 4) != 0 ? bounds.max.z : bounds.min.z);
        const glm::dvec3 clip = view.clip_from_scene * (corner - view.eye);
        // A NaN is outside of nothing, so that it never hides an object.
        outside[0] = outside[0] && clip.x < -clip.z;
        outside[1] = outside[1] && clip.x > clip.z;
        outside[2] = outside[2] && clip.y < -clip.z;
        outside[3] = outside[3] && clip.y > clip.z;
        outside[4] = outside[4] && clip.z < view.near;
    }
    return !(outside[0] || outside[1] || outside[2] || outside[3] || outside[4]);
}

MeshNumbers mesh_numbers(const ViewNumbers& view, const Transform& scene_from_object,
                         const Transform& object_from_scene) {
    const glm::dvec3 eye = object_from_scene.point(view.eye);
    MeshNumbers mesh;
    mesh.clip_from_object = glm::mat3(view.clip_from_scene * scene_from_object.linear);
    mesh.object_from_scene = glm::mat3(object_from_scene.linear);
    mesh.eye_high = glm::vec3(eye);
    mesh.eye_low = glm::vec3(eye - glm::dvec3(mesh.eye_high));
    return mesh;
}

SphereNumbers sphere_numbers(const ViewNumbers& view, const Sphere& sphere,
                             const Transform& object_from_scene) {
    const glm::dvec3 eye = (object_from_scene.point(view.eye) - sphere.centre) / sphere.radius;
    SphereNumbers numbers;
    numbers.object_from_scene = glm::mat3(object_from_scene.linear / sphere.radius);
    numbers.eye = glm::vec3(eye);
    numbers.eye_power = static_cast<float>(glm::dot(eye, eye) - 1.0);
    return numbers;
}

BoxNumbers box_numbers(const ViewNumbers& view, const Box& box,
                       const Transform& object_from_scene) {
    const glm::dvec3 eye = object_from_scene.point(view.eye);
    return {glm::mat3(object_from_scene.linear), glm::vec3(box.min - eye),
            glm::vec3(box.max - eye)};
}

PlaneNumbers plane_numbers(const ViewNumbers& view, const Plane& plane,
                           const Transform& object_from_scene) {
    const glm::dvec3 normal = glm::transpose(object_from_scene.linear) * plane.normal;
    const double height = glm::dot(plane.normal, object_from_scene.point(view.eye)) + plane.d;
    const double length = glm::length(normal);
    return {glm::vec3(normal / length), static_cast<float>(height / length)};
}

ProxyNumbers proxy_numbers(const ViewNumbers& view, const Bounds& bounds) {
    constexpr double kPixels = 0.1;  // more than the rasteriser's grid, usually 1/256 pixel
    const glm::dvec3 min = glm::dvec3(bounds.min) - view.eye;
    const glm::dvec3 max = glm::dvec3(bounds.max) - view.eye;
    const double farthest = glm::length(glm::max(glm::abs(min), glm::abs(max)));
    const glm::dvec3 margin(kPixels * view.pixel_angle * farthest);
    return {glm::vec3(min - margin), glm::vec3(max + margin)};
}

}  // namespace raypick
