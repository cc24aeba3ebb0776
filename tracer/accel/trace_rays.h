// Rays through an Accel, by the widest instructions that the processor has: the code below these
// functions is compiled once for each instruction set (Highway) and chosen at run time. The answers
// are the same, bit for bit, on all of them.
#pragma once

#include "tracer/accel/accel_state.h"
#include "tracer/accel/hit.h"
#include "tracer/geometry/ray.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

// As the queries of Accel, see there. `end`: a point where the rays end, or null.
std::optional<Hit> closest_hit(const AccelState& state, const Ray& ray, const RayQuery& query);
bool any_hit(const AccelState& state, const Ray& ray, const RayQuery& query);
std::vector<Hit> all_hits(const AccelState& state, const Ray& ray, const RayQuery& query);
void closest_hits(const AccelState& state, std::span<const Ray> rays, std::span<Hit> hits,
                  const RayQuery& query);
void any_hits(const AccelState& state, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const RayQuery& query, const glm::vec3* end);

// The instruction sets that rays can run on here, by Highway's names, best first.
std::vector<std::string> instruction_sets();
// From now on rays run on this one of them; "": on the best. For tests and measurements: not while
// rays are traced. Throws Error that names the known ones.
void use_instruction_set(std::string_view name);

}  // namespace raypick
