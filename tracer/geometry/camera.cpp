#include "tracer/geometry/camera.h"

#include "tracer/error.h"
#include "tracer/geometry/finite.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace raypick {

namespace {

// Height of the image at distance 1 in front of the eye: the notes' h. Of an orthographic view's
// image, which is the same at any distance.
double image_height(const Camera& camera) {
    if (camera.projection == Projection::orthographic) return camera.height;
    return 2.0 * std::tan(glm::radians(camera.fovy) / 2);
}

// Of the bounds' box, opposite ones first and last; of the unit cube's if they are empty.
std::array<glm::dvec3, 8> corners_of(const Bounds& bounds) {
    const glm::dvec3 low = bounds.empty() ? glm::dvec3(-0.5) : glm::dvec3(bounds.min);
    const glm::dvec3 high = bounds.empty() ? glm::dvec3(0.5) : glm::dvec3(bounds.max);
    std::array<glm::dvec3, 8> corners{};
    for (unsigned i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1u) != 0 ? high.x : low.x, (i & 2u) != 0 ? high.y : low.y,
                      (i & 4u) != 0 ? high.z : low.z};
    }
    return corners;
}

// The coordinate axis that is least parallel to v.
glm::dvec3 most_perpendicular_axis(const glm::dvec3& v) {
    const glm::dvec3 a = glm::abs(v);
    if (a.x <= a.y && a.x <= a.z) return {1, 0, 0};
    return a.z <= a.y ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
}

}  // namespace

CameraFrame camera_frame(const Camera& camera) {
    const glm::dvec3 view = glm::normalize(camera.at - camera.eye);
    glm::dvec3 side = glm::cross(view, camera.up);
    if (!(glm::length(side) > 1e-9 * glm::length(camera.up))) {
        side = glm::cross(view, most_perpendicular_axis(view));
    }
    CameraFrame frame;
    frame.vz = -view;
    frame.vx = glm::normalize(side);
    frame.vy = glm::cross(frame.vz, frame.vx);
    return frame;
}

void check_camera(const Camera& camera) {
    if (!all_finite(camera.eye) || !all_finite(camera.at) || !all_finite(camera.up)) {
        throw Error("camera: eye, at and up must be finite numbers");
    }
    if (!(glm::length(camera.at - camera.eye) > 0.0)) {
        throw Error("camera: eye and at are the same point; move one of them");
    }
    if (!(camera.fovy > 0.0 && camera.fovy < 180.0)) {
        throw Error("camera: fovy must lie between 0 and 180 degrees");
    }
    if (!(camera.height > 0.0) || !std::isfinite(camera.height)) {
        throw Error("camera: height must be a positive number");
    }
    if (!(camera.near > 0.0) || !std::isfinite(camera.near)) {
        throw Error("camera: near must be a positive number");
    }
}

RayGenerator::RayGenerator(const Camera& camera, ImageSize size)
    : frame_(camera_frame(camera)),
      eye_(camera.eye),
      near_(camera.near),
      height_(image_height(camera)),
      width_(height_ * size.aspect()),
      size_(size),
      orthographic_(camera.projection == Projection::orthographic) {}

Ray RayGenerator::ray(ImagePoint point) const {
    return ray(aside(point.c), above(point.r));
}

Ray RayGenerator::ray(double aside, double above) const {
    if (orthographic_) {
        Ray ray;
        ray.origin = glm::vec3(eye_ + aside * frame_.vx + above * frame_.vy);
        ray.direction = glm::vec3(-frame_.vz);
        ray.t_min = static_cast<float>(near_);
        return ray;
    }
    const glm::dvec3 u = aside * frame_.vx + above * frame_.vy - frame_.vz;
    const double length = glm::length(u);
    Ray ray;
    ray.origin = glm::vec3(eye_);
    ray.direction = glm::vec3(u / length);
    ray.t_min = static_cast<float>(near_ * length);  // near / cos of the angle to the view axis
    return ray;
}

Ray RayGenerator::lens_ray(ImagePoint point, const glm::dvec2& lens, double focus_distance) const {
    const glm::dvec3 across = aside(point.c) * frame_.vx + above(point.r) * frame_.vy;
    const glm::dvec3 on_lens = lens.x * frame_.vx + lens.y * frame_.vy;
    const glm::dvec3 centre = orthographic_ ? eye_ + across : eye_;
    const glm::dvec3 to_focus =
        orthographic_ ? -focus_distance * frame_.vz : focus_distance * (across - frame_.vz);
    const glm::dvec3 u = to_focus - on_lens;
    const double length = glm::length(u);
    Ray ray;
    ray.origin = glm::vec3(centre + on_lens);
    ray.direction = glm::vec3(u / length);
    ray.t_min = static_cast<float>(near_ * length / focus_distance);
    return ray;
}

RayCone RayGenerator::cone() const {
    const auto pixel = static_cast<float>(height_ / size_.rows);
    return orthographic_ ? RayCone{pixel, 0.0f} : RayCone{0.0f, pixel};
}

Ray camera_ray(const Camera& camera, ImageSize size, ImagePoint point) {
    return RayGenerator(camera, size).ray(point);
}

Ray camera_ray(const Camera& camera, ImageSize size, Pixel pixel) {
    return camera_ray(camera, size, pixel_centre(pixel));
}

std::optional<ImagePoint> project(const Camera& camera, ImageSize size, const glm::dvec3& point) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 offset = point - camera.eye;
    double depth = -glm::dot(frame.vz, offset);
    if (camera.projection == Projection::orthographic) {
        if (!(depth > camera.near)) return std::nullopt;
        depth = 1.0;
    }
    if (!(depth > 0.0)) return std::nullopt;
    const double h = image_height(camera);
    const double w = h * size.aspect();
    return ImagePoint{size.rows * (0.5 - glm::dot(frame.vy, offset) / depth / h),
                      size.cols * (0.5 + glm::dot(frame.vx, offset) / depth / w)};
}

glm::dmat4 eye_from_world(const Camera& camera) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(frame.vx, frame.vy, frame.vz));
    glm::dmat4 matrix(rotation);
    matrix[3] = glm::dvec4(-(rotation * camera.eye), 1.0);
    return matrix;
}

glm::dmat4 clip_from_eye(const Camera& camera, ImageSize size) {
    const double focal = 2.0 / image_height(camera);
    glm::dmat4 matrix(0.0);
    matrix[0][0] = focal / size.aspect();
    matrix[1][1] = focal;
    matrix[2][2] = -1.0;
    matrix[2][3] = -1.0;
    matrix[3][2] = -2.0 * camera.near;
    return matrix;
}

double near_for_bounds(const Camera& camera, const Bounds& bounds) {
    // Depth is stored as the ray's t with full float precision, so near only has to be positive:
    // it is kept so close that nothing a person can look at is cut off, and no closer, so that
    // clipping arithmetic stays well conditioned.
    const double focus = 1e-3 * glm::length(camera.at - camera.eye);
    if (bounds.empty()) return focus;
    const double size = glm::length(glm::dvec3(bounds.extent()));
    const double distance = glm::length(glm::dvec3(bounds.centre()) - camera.eye);
    return std::min(focus, 1e-5 * std::max(size, distance));
}

Camera frame_bounds(const Bounds& bounds, const glm::dvec3& direction, const glm::dvec3& up,
                    double fovy, double aspect) {
    Camera like;
    like.eye = glm::dvec3(0.0);
    like.at = direction;
    like.up = up;
    like.fovy = fovy;
    return frame_bounds(bounds, like, aspect);
}

Camera frame_bounds(const Bounds& bounds, const Camera& like, double aspect) {
    constexpr double kMargin = 1.05;
    const std::array<glm::dvec3, 8> corners = corners_of(bounds);
    Camera camera = like;
    camera.at = 0.5 * (corners.front() + corners.back());
    const glm::dvec3 view = glm::normalize(like.at - like.eye);
    camera.eye = camera.at - view;
    const CameraFrame frame = camera_frame(camera);
    const double tan_y = std::tan(glm::radians(camera.fovy) / 2) / kMargin;
    const double tan_x = tan_y * aspect;
    double distance = 0.0;
    double half_height = 0.0;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 offset = corner - camera.at;
        const double x = std::abs(glm::dot(frame.vx, offset));
        const double y = std::abs(glm::dot(frame.vy, offset));
        distance = std::max(distance, std::max(x / tan_x, y / tan_y) - glm::dot(view, offset));
        half_height = std::max(half_height, std::max(x / aspect, y));
    }
    if (!(distance > 0.0)) distance = 1.0;  // a single point
    if (!(half_height > 0.0)) half_height = 1.0;
    camera.eye = camera.at - distance * view;
    if (camera.projection == Projection::orthographic) {
        camera.height = 2.0 * kMargin * half_height;
        put_eye_before(camera, bounds);
    }
    camera.near = near_for_bounds(camera, bounds);
    return camera;
}

Camera orthographic_view(const Camera& camera, const Bounds& bounds) {
    Camera parallel = camera;
    parallel.projection = Projection::orthographic;
    if (camera.projection == Projection::perspective) {
        parallel.height = glm::distance(camera.eye, camera.at) * image_height(camera);
    }
    put_eye_before(parallel, bounds);
    parallel.near = near_for_bounds(parallel, bounds);
    return parallel;
}

Camera perspective_view(const Camera& camera) {
    Camera central = camera;
    central.projection = Projection::perspective;
    if (camera.projection == Projection::orthographic) {
        const double distance = camera.height / image_height(central);
        central.eye = camera.at + distance * camera_frame(camera).vz;
    }
    return central;
}

void put_eye_before(Camera& camera, const Bounds& bounds) {
    if (bounds.empty()) return;
    const glm::dvec3 vz = camera_frame(camera).vz;
    const glm::dvec3 centre(bounds.centre());
    const double radius = 0.5 * glm::length(glm::dvec3(bounds.extent()));
    // Bounds of a single point have no radius; the eye never stands in the plane through `at`.
    const double room = std::max(0.05 * radius, 1e-3 * camera.height);
    const double nearest = std::max(glm::dot(centre - camera.at, vz) + radius, 0.0);
    camera.eye = camera.at + (nearest + room) * vz;
}

}  // namespace raypick
