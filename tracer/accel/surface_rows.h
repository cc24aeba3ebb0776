// Surface points side by side, for vectors of whatever width the processor has.
#pragma once

#include "tracer/accel/hit.h"
#include "tracer/accel/lane_rows.h"
#include "tracer/accel/surface.h"
#include "tracer/geometry/ray.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace raypick {

// Up to 16 hits with their rays and surface points: a row for each number, a lane for each hit, so
// that all of a hit's numbers are found from one place.
struct SurfaceRows {
    static constexpr std::size_t kLanes = 16;
    // One float of each hit goes into each of these rows: its ray and t,
    static constexpr std::size_t kOrigin = 0;
    static constexpr std::size_t kDirection = 3;
    static constexpr std::size_t kT = 6;
    // and comes out of each of these: see SurfacePoint.
    static constexpr std::size_t kPosition = 7;
    static constexpr std::size_t kError = 10;
    static constexpr std::size_t kGeometric = 13;
    static constexpr std::size_t kShading = 16;
    static constexpr std::size_t kRows = 19;

    alignas(64) std::array<float, kRows * kLanes> row{};
    std::size_t count = 0;
    std::uint32_t front = 0;  // bits of the hits on a front face

    [[nodiscard]] bool full() const { return count == kLanes; }
    void clear() {
        count = 0;
        front = 0;
    }
    // One hit more, if there is room. Returns its lane.
    std::size_t add(const Ray& ray, const Hit& hit) {
        const std::size_t lane = count++;
        put_vector<kLanes>(&row[lane], kOrigin, ray.origin);
        put_vector<kLanes>(&row[lane], kDirection, ray.direction);
        row[kT * kLanes + lane] = hit.t;
        front |= (hit.front_face ? 1u : 0u) << lane;
        return lane;
    }

    // Position, bound and normals.
    void put(std::size_t lane, const SurfacePoint& point) {
        put_vector<kLanes>(&row[lane], kPosition, point.position);
        put_vector<kLanes>(&row[lane], kError, point.position_error);
        put_vector<kLanes>(&row[lane], kGeometric, point.geometric_normal);
        put_vector<kLanes>(&row[lane], kShading, point.shading_normal);
    }
    void take(std::size_t lane, SurfacePoint& point) const {
        point.position = vector_at<kLanes>(&row[lane], kPosition);
        point.position_error = vector_at<kLanes>(&row[lane], kError);
        point.geometric_normal = vector_at<kLanes>(&row[lane], kGeometric);
        point.shading_normal = vector_at<kLanes>(&row[lane], kShading);
    }
};

}  // namespace raypick
