// The numbers that shaders get for a camera and an object. Everything is computed in double and
// relative to the eye, then rounded to float once: objects and cameras may sit far from the origin.
#pragma once

#include "tracer/geometry/camera.h"
#include "tracer/geometry/shapes.h"
#include "tracer/geometry/transform.h"

#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace raypick {

// Memory layout of the uniform block View in shaders/view.glsl (std140).
struct ViewBlock {
    glm::vec4 right{0.0f};
    glm::vec4 up{0.0f};
    glm::vec4 back{0.0f};
    glm::vec4 size{0.0f};
};

// A camera at work on an image.
struct ViewNumbers {
    // Where coordinates are relative to: the origin of every perspective ray, which is the camera's
    // eye as a float; the camera's eye itself in an orthographic view.
    glm::dvec3 eye{0.0};
    glm::dmat3 clip_from_scene;  // of vectors from the eye: clip x, clip y, distance along the view
    double near = 0.0;
    bool orthographic = false;
    double pixel_height = 0.0;  // at distance 1; of an orthographic view everywhere
    ViewBlock block;
};
ViewNumbers view_numbers(const Camera& camera, ImageSize size);

// False only if nothing of the bounds can be seen: a test of its corners against the planes of the
// view. True for empty bounds (an infinite object) and for numbers that are not finite.
bool may_be_seen(const ViewNumbers& view, const Bounds& bounds);

struct MeshNumbers {
    glm::mat3 clip_from_object{1.0f};
    glm::dmat3 object_from_scene{1.0};
    glm::vec3 eye_high{0.0f};  // two floats hold the eye in object space to double precision
    glm::vec3 eye_low{0.0f};
};
MeshNumbers mesh_numbers(const ViewNumbers& view, const Transform& scene_from_object,
                         const Transform& object_from_scene);

struct SphereNumbers {
    glm::dmat3 object_from_scene{1.0};  // object: unit sphere at 0
    glm::vec3 eye{0.0f};
    float eye_power = 0.0f;  // dot(eye, eye) - 1
};
SphereNumbers sphere_numbers(const ViewNumbers& view, const Sphere& sphere,
                             const Transform& object_from_scene);

struct BoxNumbers {
    glm::dmat3 object_from_scene{1.0};
    glm::vec3 min{0.0f};  // relative to the eye
    glm::vec3 max{0.0f};
};
BoxNumbers box_numbers(const ViewNumbers& view, const Box& box, const Transform& object_from_scene);

struct PlaneNumbers {
    glm::vec3 normal{0.0f};  // scene space, unit
    float height = 0.0f;     // of the eye above the plane
    // uv of a point of the plane: uv + (dot(u, p), dot(v, p)) with p relative to the eye.
    glm::vec2 uv{0.0f};
    glm::vec3 u{0.0f};
    glm::vec3 v{0.0f};
    glm::vec3 dpdu{0.0f};  // scene space
    glm::vec3 dpdv{0.0f};
};
PlaneNumbers plane_numbers(const ViewNumbers& view, const Plane& plane,
                           const Transform& scene_from_object, const Transform& object_from_scene);

// A box around the bounds, relative to the eye and a little larger, so that rasterising its back
// faces reaches every pixel whose ray meets the bounds.
struct ProxyNumbers {
    glm::vec3 min{0.0f};
    glm::vec3 max{0.0f};
};
ProxyNumbers proxy_numbers(const ViewNumbers& view, const Bounds& bounds);

}  // namespace raypick
