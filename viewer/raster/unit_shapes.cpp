#include "viewer/raster/unit_shapes.h"

#include "tracer/geometry/axis_frame.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace raypick {

namespace {

Transform in_frame(const AxisFrame& frame, const glm::dvec3& origin, double unit) {
    return {glm::dmat3(unit * frame.x, unit * frame.y, unit * frame.z), origin};
}

}  // namespace

UnitDisk unit_shape(const Disk& disk) {
    return {static_cast<float>(disk.inner_radius / disk.radius)};
}

UnitSquare unit_shape(const Rectangle&) {
    return {};
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

}  // namespace raypick
