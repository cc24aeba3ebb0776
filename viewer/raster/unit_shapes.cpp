#include "viewer/raster/unit_shapes.h"

#include "tracer/geometry/axis_frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

Transform in_frame(const AxisFrame& frame, const glm::dvec3& origin, double unit) {
    return {glm::dmat3(unit * frame.x, unit * frame.y, unit * frame.z), origin};
}

double unit_of(const Cone& cone) {
    return std::max({glm::length(cone.apex - cone.base), cone.base_radius, cone.apex_radius});
}

}  // namespace

UnitDisk unit_shape(const Disk& disk) {
    return {static_cast<float>(disk.inner_radius / disk.radius)};
}

UnitSquare unit_shape(const Rectangle&) {
    return {};
}

UnitCone unit_shape(const Cone& cone) {
    const double unit = unit_of(cone);
    return {static_cast<float>(glm::length(cone.apex - cone.base) / unit),
            static_cast<float>(cone.base_radius / unit),
            static_cast<float>(cone.apex_radius / unit), cone.capped};
}

UnitTorus unit_shape(const Torus& torus) {
    return {static_cast<float>(torus.minor_radius / torus.major_radius)};
}

Transform object_from_unit(const Disk& disk) {
    return in_frame(axis_frame(disk.normal), disk.centre, disk.radius);
}

Transform object_from_unit(const Rectangle& rectangle) {
    const glm::dvec3 normal = glm::cross(rectangle.edge_u, rectangle.edge_v);
    // As long as the edges, so that the map can be inverted precisely.
    const glm::dvec3 across = normal / std::sqrt(glm::length(normal));
    return {glm::dmat3(rectangle.edge_u, rectangle.edge_v, across), rectangle.corner};
}

Transform object_from_unit(const Cone& cone) {
    return in_frame(axis_frame(cone.apex - cone.base), cone.base, unit_of(cone));
}

Transform object_from_unit(const Torus& torus) {
    return in_frame(axis_frame(torus.axis), torus.centre, torus.major_radius);
}

}  // namespace raypick
