// Affine maps between object and world space, in double precision.
#pragma once

#include "tracer/geometry/bounds.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace raypick {

// world = linear * object + translation. Double, because objects may sit far from the origin.
struct Transform {
    glm::dmat3 linear{1.0};
    glm::dvec3 translation{0.0};

    [[nodiscard]] glm::dvec3 point(const glm::dvec3& p) const { return linear * p + translation; }
    [[nodiscard]] glm::dvec3 vector(const glm::dvec3& v) const { return linear * v; }
    [[nodiscard]] bool is_identity() const;
    // True if the map turns counter-clockwise triangles into clockwise ones.
    [[nodiscard]] bool mirrors() const;

    friend bool operator==(const Transform&, const Transform&) = default;
};

Transform translate(const glm::dvec3& offset);
Transform scale(const glm::dvec3& factors);
// Right-handed rotation by `degrees` about `axis` (any length but 0).
Transform rotate(double degrees, const glm::dvec3& axis);
// From the top three rows of an affine 4x4 matrix (column vectors).
Transform from_matrix(const glm::dmat4& matrix);
glm::dmat4 to_matrix(const Transform& transform);

// Applies `inner` first, then `outer`.
Transform operator*(const Transform& outer, const Transform& inner);

// Nothing if the map is singular (flattens space) or holds a NaN or an infinity.
std::optional<Transform> inverse(const Transform& transform);

// Outward normal in world space, unit length: the inverse transpose applied to an object-space
// normal, so that it stays perpendicular under non-uniform and mirrored scale. `object_from_world`
// is the inverse map.
glm::dvec3 world_normal(const Transform& object_from_world, const glm::dvec3& object_normal);

// Tight for the eight corners, rounded outwards to float.
Bounds world_bounds(const Transform& world_from_object, const glm::dvec3& min,
                    const glm::dvec3& max);

}  // namespace raypick
