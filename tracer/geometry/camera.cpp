#include "tracer/geometry/camera.h"

#include "tracer/error.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

// Height of the image at distance 1 in front of the eye: the notes' h.
double image_height(const Camera& camera) {
    return 2.0 * std::tan(glm::radians(camera.fovy) / 2);
}

bool all_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
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
      size_(size) {}

Ray RayGenerator::ray(ImagePoint point) const {
    const double ax = width_ * (point.c / size_.cols - 0.5);
    const double ay = -height_ * (point.r / size_.rows - 0.5);
    const glm::dvec3 u = ax * frame_.vx + ay * frame_.vy - frame_.vz;
    const double length = glm::length(u);
    Ray ray;
    ray.origin = glm::vec3(eye_);
    ray.direction = glm::vec3(u / length);
    ray.t_min = static_cast<float>(near_ * length);  // near / cos of the angle to the view axis
    return ray;
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
    const double depth = -glm::dot(frame.vz, offset);
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
    constexpr double kMargin = 1.05;
    const bool empty = bounds.empty();
    const glm::dvec3 low = empty ? glm::dvec3(-0.5) : glm::dvec3(bounds.min);
    const glm::dvec3 high = empty ? glm::dvec3(0.5) : glm::dvec3(bounds.max);
    Camera camera;
    camera.at = 0.5 * (low + high);
    camera.up = up;
    camera.fovy = fovy;
    const glm::dvec3 view = glm::normalize(direction);
    camera.eye = camera.at - view;
    const CameraFrame frame = camera_frame(camera);
    const double tan_y = image_height(camera) / 2 / kMargin;
    const double tan_x = tan_y * aspect;
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                           (corner & 4) != 0 ? high.z : low.z);
        const glm::dvec3 offset = p - camera.at;
        const double across = std::max(std::abs(glm::dot(frame.vx, offset)) / tan_x,
                                       std::abs(glm::dot(frame.vy, offset)) / tan_y);
        distance = std::max(distance, across - glm::dot(view, offset));
    }
    if (!(distance > 0.0)) distance = 1.0;  // a single point
    camera.eye = camera.at - distance * view;
    camera.near = near_for_bounds(camera, bounds);
    return camera;
}

}  // namespace raypick
