// What rays cross, many at a time and by the widest instructions that the processor has: see
// trace_rays.h.
#pragma once

#include "tracer/accel/accel_state.h"
#include "tracer/accel/crossings.h"
#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"

#include <glm/vec3.hpp>

#include <span>

namespace raypick {

// As the query of Accel, see there. `end`: a point where the rays end, or null.
void find_crossings(const AccelState& state, std::span<const Ray> rays, const Clearness& clear,
                    Crossings& crossings, const RayQuery& query, const glm::vec3* end);

}  // namespace raypick
