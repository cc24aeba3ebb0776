#include "tracer/geometry/transform.h"

#include "tracer/geometry/finite.h"
#include "tracer/geometry/rounding.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <cmath>

namespace raypick {

bool Transform::is_identity() const {
    return *this == Transform{};
}

bool Transform::mirrors() const {
    return glm::determinant(linear) < 0.0;
}

Transform translate(const glm::dvec3& offset) {
    return {glm::dmat3(1.0), offset};
}

Transform scale(const glm::dvec3& factors) {
    Transform result;
    for (int axis = 0; axis < 3; ++axis)
        result.linear[axis][axis] = factors[axis];
    return result;
}

Transform rotate(double degrees, const glm::dvec3& axis) {
    const glm::dmat4 rotation = glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis);
    return {glm::dmat3(rotation), glm::dvec3(0.0)};
}

Transform from_matrix(const glm::dmat4& matrix) {
    return {glm::dmat3(matrix), glm::dvec3(matrix[3])};
}

glm::dmat4 to_matrix(const Transform& transform) {
    glm::dmat4 matrix(transform.linear);
    matrix[3] = glm::dvec4(transform.translation, 1.0);
    return matrix;
}

Transform operator*(const Transform& outer, const Transform& inner) {
    return {outer.linear * inner.linear, outer.point(inner.translation)};
}

std::optional<Transform> inverse(const Transform& transform) {
    const double determinant = glm::determinant(transform.linear);
    if (!(std::abs(determinant) > 0.0) || !std::isfinite(determinant)) return std::nullopt;
    const glm::dmat3 linear = glm::inverse(transform.linear);
    const Transform result{linear, -(linear * transform.translation)};
    for (int column = 0; column < 3; ++column) {
        if (!all_finite(result.linear[column])) return std::nullopt;
    }
    if (!all_finite(result.translation)) return std::nullopt;
    return result;
}

glm::dvec3 world_normal(const Transform& object_from_world, const glm::dvec3& object_normal) {
    return glm::normalize(glm::transpose(object_from_world.linear) * object_normal);
}

Bounds world_bounds(const Transform& world_from_object, const glm::dvec3& min,
                    const glm::dvec3& max) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p = world_from_object.point({(corner & 1) != 0 ? max.x : min.x,
                                                      (corner & 2) != 0 ? max.y : min.y,
                                                      (corner & 4) != 0 ? max.z : min.z});
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return rounded_outwards(low, high);
}

}  // namespace raypick
