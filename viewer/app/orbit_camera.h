// The camera as a person moves it: a turntable about an upright axis, with pan and zoom.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/camera.h"

namespace raypick {

// The directions that keys ask for, by where the eye stands.
enum class ViewSide { front, back, right, left, top, bottom };

// Looks at a pivot (the camera's `at`). The horizon stays level with respect to the axis, and the
// view stops at the poles instead of flipping over. All in double, scene space. Until something
// moves it, camera() is exactly the camera it was given.
class OrbitCamera {
public:
    OrbitCamera() = default;
    // The axis is the camera's up.
    explicit OrbitCamera(const Camera& camera);

    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] double pivot_distance() const;

    // Sets near from the bounds of the scene's finite objects, and the limits of zooming with it.
    // An orthographic view that was moved stands before all of them.
    void fit_to_scene(const Bounds& bounds);
    // Turns about the pivot as if the scene were pushed by the cursor: radians to the right and
    // down.
    void orbit(double right, double down);
    // Moves so that what is at `from` in the pivot's plane comes to `to`.
    void pan(ImageSize size, ImagePoint from, ImagePoint to);
    // Moves the pivot along the view axis to this depth in front of the eye; the view stays.
    void set_pivot_depth(double depth);
    // Looks from one side, about the pivot and at the same distance. Where y is the axis the front
    // is at +z and the right at +x; where z is, the front is at -y.
    void look_from(ViewSide side);
    // Between perspective and orthographic; what lies at the pivot keeps its size.
    void toggle_projection();
    // Scales the distances to the point of the pivot's plane at `at` by `factor` (< 1: nearer);
    // that point stays where it is on the image.
    void zoom(ImageSize size, ImagePoint at, double factor);
    // Keeps the direction and fits the bounds into the view. Empty bounds change nothing.
    void frame(const Bounds& bounds, ImageSize size);
    // Keeps direction and distance and looks at a point.
    void look_at(const glm::dvec3& point);

private:
    [[nodiscard]] bool parallel() const { return camera_.projection == Projection::orthographic; }
    // Of what the image shows of the pivot's plane, scene units.
    [[nodiscard]] double pivot_plane_height() const;
    void stand_before_scene();
    [[nodiscard]] glm::dvec3 pivot_plane_point(ImageSize size, ImagePoint at) const;

    Camera camera_;
    glm::dvec3 axis_{0.0, 1.0, 0.0};
    Bounds scene_;
    double min_distance_ = 1e-6;
    double max_distance_ = 1e12;
};

}  // namespace raypick
