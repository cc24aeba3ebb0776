#include "viewer/app/orbit_camera.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raypick {

namespace {

glm::dvec3 rotated(const glm::dvec3& v, const glm::dvec3& unit_axis, double radians) {
    // Rodrigues' formula.
    const double c = std::cos(radians);
    const double s = std::sin(radians);
    return c * v + s * glm::cross(unit_axis, v) + (1.0 - c) * glm::dot(unit_axis, v) * unit_axis;
}

// Where the front of a thing is whose upright axis is this: z, turned as y is turned to the axis.
glm::dvec3 front_of(const glm::dvec3& axis) {
    const glm::dvec3 y{0.0, 1.0, 0.0};
    const glm::dvec3 z{0.0, 0.0, 1.0};
    const glm::dvec3 side = glm::cross(y, axis);
    const double sine = glm::length(side);
    if (sine == 0.0) return axis.y < 0.0 ? -z : z;
    return rotated(z, side / sine, std::atan2(sine, axis.y));
}

double radius_of(const Bounds& bounds) {
    return 0.5 * glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}

// Bounds of a point or a flat thing have no size to fit; give them one in proportion to where they
// are.
Bounds with_some_size(const Bounds& bounds, double least_radius) {
    if (radius_of(bounds) > 0.0) return bounds;
    Bounds grown = bounds;
    grown.min -= glm::vec3(static_cast<float>(least_radius));
    grown.max += glm::vec3(static_cast<float>(least_radius));
    return grown;
}

}  // namespace

OrbitCamera::OrbitCamera(const Camera& camera) : camera_(camera) {
    const CameraFrame frame = camera_frame(camera);
    const double length = glm::length(camera.up);
    axis_ = length > 0.0 ? camera.up / length : frame.vy;
}

double OrbitCamera::pivot_distance() const {
    return glm::distance(camera_.eye, camera_.at);
}

void OrbitCamera::fit_to_scene(const Bounds& bounds) {
    scene_ = bounds;
    camera_.near = near_for_bounds(camera_, bounds);
    const double radius = bounds.empty() ? 0.0 : radius_of(bounds);
    if (!(radius > 0.0)) return;
    min_distance_ = 1e-5 * radius;
    max_distance_ = 1e4 * radius;
}

void OrbitCamera::orbit(double right, double down) {
    const double distance = pivot_distance();
    const CameraFrame frame = camera_frame(camera_);
    // A level right vector: it defines the azimuth also when looking straight along the axis.
    const glm::dvec3 level = glm::normalize(frame.vx - glm::dot(frame.vx, axis_) * axis_);
    const glm::dvec3 vx = rotated(level, axis_, -right);
    const glm::dvec3 outwards = glm::cross(vx, axis_);
    constexpr double kPole = std::numbers::pi / 2.0;
    const double elevation = std::asin(std::clamp(glm::dot(frame.vz, axis_), -1.0, 1.0));
    // Further than the pole would turn the picture upside down.
    const double turned = std::clamp(elevation + down, -kPole, kPole);
    const glm::dvec3 vz = std::cos(turned) * outwards + std::sin(turned) * axis_;
    camera_.eye = camera_.at + distance * vz;
    // Perpendicular to the view, so that the frame is defined at the poles, too.
    camera_.up = glm::cross(vz, vx);
    stand_before_scene();
}

void OrbitCamera::look_from(ViewSide side) {
    const glm::dvec3 front = front_of(axis_);
    const glm::dvec3 right = glm::cross(axis_, front);
    glm::dvec3 to_eye = front;
    glm::dvec3 up = axis_;
    switch (side) {
        case ViewSide::front:
            break;
        case ViewSide::back:
            to_eye = -front;
            break;
        case ViewSide::right:
            to_eye = right;
            break;
        case ViewSide::left:
            to_eye = -right;
            break;
        case ViewSide::top:
            to_eye = axis_;
            up = -front;
            break;
        case ViewSide::bottom:
            to_eye = -axis_;
            up = front;
            break;
    }
    camera_.eye = camera_.at + pivot_distance() * to_eye;
    camera_.up = up;
    stand_before_scene();
}

void OrbitCamera::toggle_projection() {
    camera_ = parallel() ? perspective_view(camera_) : orthographic_view(camera_, scene_);
}

void OrbitCamera::stand_before_scene() {
    if (parallel()) put_eye_before(camera_, scene_);
}

double OrbitCamera::pivot_plane_height() const {
    if (parallel()) return camera_.height;
    return 2.0 * pivot_distance() * std::tan(0.5 * glm::radians(camera_.fovy));
}

glm::dvec3 OrbitCamera::pivot_plane_point(ImageSize size, ImagePoint at) const {
    const CameraFrame frame = camera_frame(camera_);
    const double height = pivot_plane_height();
    const double width = height * size.aspect();
    return camera_.at + width * (at.c / size.cols - 0.5) * frame.vx -
           height * (at.r / size.rows - 0.5) * frame.vy;
}

void OrbitCamera::pan(ImageSize size, ImagePoint from, ImagePoint to) {
    const glm::dvec3 offset = pivot_plane_point(size, from) - pivot_plane_point(size, to);
    camera_.eye += offset;
    camera_.at += offset;
    stand_before_scene();
}

void OrbitCamera::set_pivot_depth(double depth) {
    const double wanted = std::clamp(depth, min_distance_, max_distance_);
    camera_.at = camera_.eye - wanted * camera_frame(camera_).vz;
}

void OrbitCamera::zoom(ImageSize size, ImagePoint at, double factor) {
    const double now = parallel() ? camera_.height : pivot_distance();
    const double wanted = std::clamp(factor * now, min_distance_, max_distance_);
    const glm::dvec3 fixed = pivot_plane_point(size, at);
    if (parallel()) {
        // Sideways only: parallel rays don't grow with nearness.
        const glm::dvec3 offset = (1.0 - wanted / now) * (fixed - camera_.at);
        camera_.eye += offset;
        camera_.at += offset;
        camera_.height = wanted;
        stand_before_scene();
        return;
    }
    camera_.eye = fixed + (wanted / now) * (camera_.eye - fixed);
    camera_.at = fixed + (wanted / now) * (camera_.at - fixed);
}

void OrbitCamera::frame(const Bounds& bounds, ImageSize size) {
    if (bounds.empty() || size.rows <= 0 || size.cols <= 0) return;
    const Bounds box = with_some_size(bounds, 0.1 * pivot_distance());
    camera_.up = camera_frame(camera_).vy;
    camera_ = frame_bounds(box, camera_, size.aspect());
    stand_before_scene();
}

void OrbitCamera::look_at(const glm::dvec3& point) {
    const glm::dvec3 offset = point - camera_.at;
    camera_.eye += offset;
    camera_.at += offset;
    stand_before_scene();
}

}  // namespace raypick
