// The camera: what gluLookAt and gluPerspective take. It gives both the rays and the GL matrices,
// so that they can't disagree.
//
// Source: David Mount, CMSC 427 lecture notes (2017), "Ray Tracing and Picking": Ray Generation.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/pixel.h"
#include "tracer/geometry/ray.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <span>

namespace raypick {

enum class Projection { perspective, orthographic };

// In scene space (file coordinates minus the scene's origin).
struct Camera {
    glm::dvec3 eye{0.0, 0.0, 5.0};
    glm::dvec3 at{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double fovy = 45.0;  // full vertical angle, degrees, in (0, 180)
    double near = 1e-3;  // distance of the near plane along the view axis, > 0; far is infinite
    Projection projection = Projection::perspective;
    double height =
        2.0;  // of what an orthographic view shows, scene units; fovy means nothing there

    friend bool operator==(const Camera&, const Camera&) = default;
};

// The orthonormal camera frame of the notes: the camera looks along -vz, vy is up on the image.
struct CameraFrame {
    glm::dvec3 vx{1.0, 0.0, 0.0};
    glm::dvec3 vy{0.0, 1.0, 0.0};
    glm::dvec3 vz{0.0, 0.0, 1.0};
};

// If `up` is parallel to the view, another up axis is chosen (the frame is always orthonormal).
CameraFrame camera_frame(const Camera& camera);

// Throws Error if eye equals at, fovy is outside (0, 180), height or near is not positive, or a
// number is not finite. Callers that take a camera from a person call this first.
void check_camera(const Camera& camera);

// The ray through an image point, real r and c: pixel corners are integers, centres + 0.5. Unit
// direction; t_min is the near plane's distance along this ray. Orthographic rays are parallel to
// the view axis and begin in the plane through the eye.
Ray camera_ray(const Camera& camera, ImageSize size, ImagePoint point);
// Through a pixel's centre. The one ray generator for clicks and frames.
Ray camera_ray(const Camera& camera, ImageSize size, Pixel pixel);

// Many rays of one frame: the same rays as camera_ray, with the per-frame work done once.
class RayGenerator {
public:
    RayGenerator(const Camera& camera, ImageSize size);

    [[nodiscard]] Ray ray(ImagePoint point) const;
    // The same in steps, for callers that keep what belongs to a row or a column: how far to the
    // side of the view axis the point lies, and how far above, in the image at distance 1.
    [[nodiscard]] double aside(double c) const { return width_ * (c / size_.cols - 0.5); }
    [[nodiscard]] double above(double r) const { return -height_ * (r / size_.rows - 0.5); }
    [[nodiscard]] Ray ray(double aside, double above) const;
    // The same of many points, to the bit, as vectors of whatever width the processor has. All
    // three are equally long.
    void rays(std::span<const double> aside, std::span<const double> above,
              std::span<Ray> rays) const;
    // The ray through the same point of the plane at `focus_distance` (> 0) in front of the eye
    // that comes from another point of a thin lens: `lens`, along vx and vy from the lens's centre,
    // scene units. Everything in that plane is sharp.
    [[nodiscard]] Ray lens_ray(ImagePoint point, const glm::dvec2& lens,
                               double focus_distance) const;
    // What each ray's pixel covers: the height of a pixel.
    [[nodiscard]] RayCone cone() const;

private:
    CameraFrame frame_;
    glm::dvec3 eye_;
    double near_;
    double height_;  // of the image at distance 1; of an orthographic view's everywhere
    double width_;
    ImageSize size_;
    bool orthographic_;
};

// The image point that a scene-space point projects to; nothing if it is not in front of the eye
// (perspective) or the near plane (orthographic).
std::optional<ImagePoint> project(const Camera& camera, ImageSize size, const glm::dvec3& point);

// OpenGL's matrices: eye space looks along -z, clip space z in [-w, w], far at infinity.
glm::dmat4 eye_from_world(const Camera& camera);
glm::dmat4 clip_from_eye(const Camera& camera, ImageSize size);

// The near distance for a view of a scene whose finite objects have `bounds`: in front of
// everything that the camera can see, yet never so small that depth precision suffers.
double near_for_bounds(const Camera& camera, const Bounds& bounds);

// A camera that looks along `direction` (from the eye into the scene) with the bounds just filling
// an image of this aspect ratio. Empty bounds give the unit cube's view.
Camera frame_bounds(const Bounds& bounds, const glm::dvec3& direction, const glm::dvec3& up,
                    double fovy, double aspect);
// The same with this camera's direction, up, fovy and projection. In an orthographic view all of
// the bounds lie in front of the eye.
Camera frame_bounds(const Bounds& bounds, const Camera& like, double aspect);

// The same view by parallel rays: what lies in the plane through `at` keeps its size. The eye moves
// along the view axis to where all of the bounds lie in front of it.
Camera orthographic_view(const Camera& camera, const Bounds& bounds);
// An orthographic view by rays from one point, which keeps the size of what lies in the plane
// through `at`. Its fovy is the camera's.
Camera perspective_view(const Camera& camera);
// Moves the eye of an orthographic camera along its view axis, which doesn't change the view but
// for what is behind the eye, to where all of the bounds are in front of it.
void put_eye_before(Camera& camera, const Bounds& bounds);

}  // namespace raypick
