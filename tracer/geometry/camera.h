// The camera: what gluLookAt and gluPerspective take. It gives both the rays and the GL matrices,
// so that they can't disagree.
//
// Source: David Mount, CMSC 427 lecture notes (2017), "Ray Tracing and Picking": Ray Generation.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/pixel.h"
#include "tracer/geometry/ray.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace raypick {

// In scene space (file coordinates minus the scene's origin).
struct Camera {
    glm::dvec3 eye{0.0, 0.0, 5.0};
    glm::dvec3 at{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double fovy = 45.0;  // full vertical angle, degrees, in (0, 180)
    double near = 1e-3;  // distance of the near plane along the view axis, > 0; far is infinite

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

// Throws Error if eye equals at, fovy is outside (0, 180), near is not positive, or a number is not
// finite. Callers that take a camera from a person call this first.
void check_camera(const Camera& camera);

// The ray through an image point, real r and c: pixel corners are integers, centres + 0.5. Unit
// direction; t_min is the near plane's distance along this ray.
Ray camera_ray(const Camera& camera, ImageSize size, ImagePoint point);
// Through a pixel's centre. The one ray generator for clicks and frames.
Ray camera_ray(const Camera& camera, ImageSize size, Pixel pixel);

// Many rays of one frame: the same rays as camera_ray, with the per-frame work done once.
class RayGenerator {
public:
    RayGenerator(const Camera& camera, ImageSize size);

    [[nodiscard]] Ray ray(ImagePoint point) const;

private:
    CameraFrame frame_;
    glm::dvec3 eye_;
    double near_;
    double height_;  // of the image at distance 1
    double width_;
    ImageSize size_;
};

// The image point that a scene-space point projects to; nothing if it is not in front of the eye.
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

}  // namespace raypick
