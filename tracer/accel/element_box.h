// The elements of sets as builders of trees see them.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/geometry/rounding.h"
#include "tracer/geometry/shapes.h"
#include "tracer/scene/scene.h"

#include <cstddef>
#include <cstdint>

namespace raypick {

inline Bounds element_box(const SphereSet& set, std::size_t index) {
    const Sphere sphere = sphere_of(set, static_cast<std::uint32_t>(index));
    return rounded_outwards(sphere.centre - sphere.radius, sphere.centre + sphere.radius);
}

// Of the two disks at the ends.
inline Bounds element_box(const ConeSet& set, std::size_t index) {
    const Cone cone = cone_of(set, static_cast<std::uint32_t>(index));
    const ObjectExtent extent = shape_extent(cone);
    return rounded_outwards(extent.min, extent.max);
}

}  // namespace raypick
