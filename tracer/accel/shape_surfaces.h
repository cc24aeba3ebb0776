// Surface points on spheres and rectangles, many at once.
#pragma once

#include "tracer/accel/surface.h"
#include "tracer/accel/surface_rows.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// Works the surface points of spheres' or of rectangles' hits out together, as vectors of whatever
// width the processor has. What set_surface_point says, to the bit.
class ShapeSurfaces {
public:
    // What add() takes: spheres and rectangles that nothing moves and no texture needs.
    enum class Kind { other, sphere, rectangle };
    [[nodiscard]] static Kind kind(const HitObject& at);

    // Of the hit that these rows have in this lane: all are of one kind, which is not `other`.
    void add(std::size_t lane, const Scene& scene, const Shape& shape, std::uint32_t primitive);
    // Set the points of the rows' hits, all of which have been added.
    void find_spheres(SurfaceRows& rows) const;
    void find_rectangles(SurfaceRows& rows) const;

    // One double of each hit goes into each of these rows: of a sphere
    static constexpr std::size_t kCentre = 0;
    static constexpr std::size_t kRadius = 3;
    // or a rectangle.
    static constexpr std::size_t kCorner = 0;
    static constexpr std::size_t kEdgeU = 3;
    static constexpr std::size_t kEdgeV = 6;
    static constexpr std::size_t kInputs = 9;
    static constexpr std::size_t kLanes = SurfaceRows::kLanes;
    struct Inputs {
        alignas(64) std::array<double, kInputs * kLanes> row{};
    };

private:
    Inputs in_;
};

}  // namespace raypick
