#include "viewer/raster/view_numbers.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace raypick {

namespace {

// The coordinate axes that give a plane's uv, and the one along which its normal is longest.
struct PlaneAxes {
    int u = 0;
    int v = 1;
    int w = 2;
};

// As plane_uv in tracer/geometry/shapes.cpp.
PlaneAxes plane_axes(const glm::dvec3& normal) {
    const glm::dvec3 n = glm::abs(normal);
    if (n.x > n.y && n.x > n.z) return {1, 2, 0};
    return n.y >= n.z ? PlaneAxes{0, 2, 1} : PlaneAxes{0, 1, 2};
}

// How a point of the plane moves as one of its uv axes grows and the other one stays.
glm::dvec3 along_plane(const glm::dvec3& normal, const PlaneAxes& axes, int axis) {
    glm::dvec3 direction(0.0);
    direction[axis] = 1.0;
    direction[axes.w] = -normal[axis] / normal[axes.w];
    return direction;
}

}  // namespace

ViewNumbers view_numbers(const Camera& camera, ImageSize size) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dmat4 clip = clip_from_eye(camera, size);
    const double pixel_width = 2.0 / clip[0][0] / size.cols;
    const double pixel_height = 2.0 / clip[1][1] / size.rows;
    ViewNumbers view;
    view.orthographic = camera.projection == Projection::orthographic;
    view.eye = view.orthographic ? camera.eye : glm::dvec3(glm::vec3(camera.eye));
    view.clip_from_scene =
        glm::transpose(glm::dmat3(clip[0][0] * frame.vx, clip[1][1] * frame.vy, -frame.vz));
    view.near = camera.near;
    view.pixel_height = pixel_height;
    view.block.right =
        glm::vec4(glm::vec3(pixel_width * frame.vx), view.orthographic ? 1.0f : 0.0f);
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
        const double w = view.orthographic ? 1.0 : clip.z;
        // A NaN is outside of nothing, so that it never hides an object.
        outside[0] = outside[0] && clip.x < -w;
        outside[1] = outside[1] && clip.x > w;
        outside[2] = outside[2] && clip.y < -w;
        outside[3] = outside[3] && clip.y > w;
        outside[4] = outside[4] && clip.z < view.near;
    }
    return !(outside[0] || outside[1] || outside[2] || outside[3] || outside[4]);
}

MeshNumbers mesh_numbers(const ViewNumbers& view, const Transform& scene_from_object,
                         const Transform& object_from_scene) {
    const glm::dvec3 eye = object_from_scene.point(view.eye);
    MeshNumbers mesh;
    mesh.clip_from_object = glm::mat3(view.clip_from_scene * scene_from_object.linear);
    mesh.object_from_scene = object_from_scene.linear;
    mesh.eye_high = glm::vec3(eye);
    mesh.eye_low = glm::vec3(eye - glm::dvec3(mesh.eye_high));
    return mesh;
}

SphereNumbers sphere_numbers(const ViewNumbers& view, const Sphere& sphere,
                             const Transform& object_from_scene) {
    const glm::dvec3 eye = (object_from_scene.point(view.eye) - sphere.centre) / sphere.radius;
    SphereNumbers numbers;
    numbers.object_from_scene = object_from_scene.linear / sphere.radius;
    numbers.eye = glm::vec3(eye);
    numbers.eye_power = static_cast<float>(glm::dot(eye, eye) - 1.0);
    return numbers;
}

BoxNumbers box_numbers(const ViewNumbers& view, const Box& box,
                       const Transform& object_from_scene) {
    const glm::dvec3 eye = object_from_scene.point(view.eye);
    return {object_from_scene.linear, glm::vec3(box.min - eye), glm::vec3(box.max - eye)};
}

PlaneNumbers plane_numbers(const ViewNumbers& view, const Plane& plane,
                           const Transform& scene_from_object, const Transform& object_from_scene) {
    const glm::dvec3 normal = glm::transpose(object_from_scene.linear) * plane.normal;
    const glm::dvec3 eye = object_from_scene.point(view.eye);
    const double length = glm::length(normal);
    PlaneNumbers numbers;
    numbers.normal = glm::vec3(normal / length);
    numbers.height = static_cast<float>((glm::dot(plane.normal, eye) + plane.d) / length);
    const PlaneAxes axes = plane_axes(plane.normal);
    const glm::dmat3 rows = glm::transpose(object_from_scene.linear);
    numbers.uv = glm::vec2(eye[axes.u], eye[axes.v]);
    numbers.u = glm::vec3(rows[axes.u]);
    numbers.v = glm::vec3(rows[axes.v]);
    numbers.dpdu = glm::vec3(scene_from_object.vector(along_plane(plane.normal, axes, axes.u)));
    numbers.dpdv = glm::vec3(scene_from_object.vector(along_plane(plane.normal, axes, axes.v)));
    return numbers;
}

ProxyNumbers proxy_numbers(const ViewNumbers& view, const Bounds& bounds) {
    constexpr double kPixels = 0.1;  // more than the rasteriser's grid, usually 1/256 pixel
    const glm::dvec3 min = glm::dvec3(bounds.min) - view.eye;
    const glm::dvec3 max = glm::dvec3(bounds.max) - view.eye;
    const double farthest = glm::length(glm::max(glm::abs(min), glm::abs(max)));
    const glm::dvec3 margin(kPixels * view.pixel_height * (view.orthographic ? 1.0 : farthest) +
                            0x1p-22 * farthest);
    return {glm::vec3(min - margin), glm::vec3(max + margin)};
}

}  // namespace raypick
