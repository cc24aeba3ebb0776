// A pick: what lies under a pixel, with everything a person wants to know about it.
#pragma once

#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"
#include "tracer/geometry/camera.h"

#include <optional>
#include <string>
#include <vector>

namespace raypick {

// A hit with names, in file coordinates (scene origin added).
struct Pick {
    Hit hit;
    std::string object;    // the object's name
    std::string path;      // its place in the file's tree
    std::string material;  // "" if it has none
    glm::dvec3 point{0.0};
    glm::vec3 normal{0.0f};  // shading normal, unit, outward
};

// Where a pick came from: a pixel of a view, or a bare ray.
struct PixelPick {
    Pixel pixel;
    std::optional<Pick> pick;  // nothing: background
};

// The first thing under a pixel: camera_ray through its centre, Accel::intersect, surface_point.
std::optional<Pick> pick_pixel(const Accel& accel, const Camera& camera, ImageSize size,
                               Pixel pixel, const RayQuery& query = {});
std::optional<Pick> pick_ray(const Accel& accel, const Ray& ray, const RayQuery& query = {});
// Everything along the ray, nearest first.
std::vector<Pick> pick_all(const Accel& accel, const Ray& ray, const RayQuery& query = {});

// Names and places for a hit of this ray.
Pick describe(const Accel& accel, const Ray& ray, const Hit& hit);

// One line of JSON (no line end): row col hit object object_id primitive t point normal uv
// front_face material, as `raypick pick` prints it. `hit` is false and the rest is missing on
// background.
std::string to_json(const PixelPick& pick);
// The same with "hits": every hit in order; the outer fields are the first one's.
std::string to_json(Pixel pixel, const std::vector<Pick>& picks);
// For bare rays: ox oy oz dx dy dz stand as "origin" and "direction" (file coordinates) in place of
// row and col.
std::string to_json(const glm::dvec3& origin, const glm::dvec3& direction,
                    const std::optional<Pick>& pick);
std::string to_json(const glm::dvec3& origin, const glm::dvec3& direction,
                    const std::vector<Pick>& picks);

}  // namespace raypick
