#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/trace_crossings.cpp"
#include <hwy/foreach_target.h>

#include "tracer/accel/simd/crossed_elements-inl.h"
#include "tracer/accel/simd/group_crossings-inl.h"
#include "tracer/accel/simd/group_trace-inl.h"
#include "tracer/accel/simd/ray_chunk-inl.h"
#include "tracer/accel/simd/ray_run-inl.h"
#include "tracer/accel/trace_crossings.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace {

// Memory that chunks share.
struct CrossingRoom {
    std::vector<PerhapsCrossed> perhaps;
    std::vector<CrossedHit> hits;  // of the chunk at work
};

// The mask's rays are usable.
void cross_one_by_one(const AccelState& state, RayMask mask, std::span<const Ray> rays,
                      const RayQuery& query, CrossingsOfGroup& search) {
    each_ray(mask, [&](std::size_t ray) HWY_ATTR {
        search.limits.t_far[ray] = rays[ray].t_max;
        CrossingsOfOne one{search, ray};
        trace_ray(state, from_origin(rays[ray]), query, one);
    });
}

// The rays that are blocked; hits of all go into the room. `end`: where the rays end, if it is not
// null.
RayMask cross_chunk(const AccelState& state, std::span<const Ray> rays, const Clearness& clear,
                    const RayQuery& query, const glm::vec3* end, RayRun& run, CrossingRoom& room) {
    const Chunk chunk(state, rays, query);
    RayMask blocked = 0;
    for (const RayMask mask : chunk.octants) {
        if (mask == 0) continue;
        CrossingsOfGroup search(*state.scene, clear, room.perhaps, room.hits);
        search.limits = chunk.limits;
        GroupTrace(state, rays, query, run, search).run_towards(chunk, mask, end);
        decide_crossed({state, rays, query, search});
        blocked |= search.blocked;
    }
    if (chunk.apart != 0) {
        CrossingsOfGroup search(*state.scene, clear, room.perhaps, room.hits);
        search.limits = chunk.limits;
        RaysApart(state, rays, query, search).run(chunk.apart);
        decide_crossed({state, rays, query, search});
        blocked |= search.blocked;
    }
    if (chunk.alone != 0) {
        CrossingsOfGroup search(*state.scene, clear, room.perhaps, room.hits);
        cross_one_by_one(state, chunk.alone, rays, query, search);
        blocked |= search.blocked;
    }
    return blocked;
}

// Puts the hits of a chunk of rays in order behind those that are there.
void append_chunk(RayMask blocked, std::size_t count, std::span<const CrossedHit> hits,
                  Crossings& crossings) {
    std::array<std::uint32_t, kGroup + 1> place{};
    for (const CrossedHit& crossed : hits) {
        if (((blocked >> crossed.ray) & 1) == 0) ++place[crossed.ray + 1];
    }
    auto next = static_cast<std::uint32_t>(crossings.hits.size());
    for (std::size_t ray = 0; ray < count; ++ray) {
        crossings.blocked.push_back(static_cast<std::uint8_t>((blocked >> ray) & 1));
        crossings.first.push_back(next);
        const std::uint32_t its_own = place[ray + 1];
        place[ray] = next;
        next += its_own;
    }
    crossings.hits.resize(next);
    for (const CrossedHit& crossed : hits) {
        if (((blocked >> crossed.ray) & 1) != 0) continue;
        crossings.hits[place[crossed.ray]++] = crossed.hit;
    }
}

}  // namespace

void find_crossings(const AccelState& state, std::span<const Ray> rays, const Clearness& clear,
                    Crossings& crossings, const RayQuery& query, const glm::vec3* end) {
    crossings.blocked.clear();
    crossings.hits.clear();
    crossings.first.clear();
    if (!state.mostly_triangles) end = nullptr;  // as any_hits does
    CrossingRoom room;
    std::optional<RayRun> run;
    for (std::size_t i = 0; i < rays.size(); i += kGroup) {
        if (i % RayRun::kMostRays == 0) run.emplace(state, rays_of_run(rays, i), end);
        const std::size_t count = std::min(kGroup, rays.size() - i);
        room.hits.clear();
        const RayMask blocked =
            cross_chunk(state, rays.subspan(i, count), clear, query, end, *run, room);
        append_chunk(blocked, count, room.hits, crossings);
    }
    crossings.first.push_back(static_cast<std::uint32_t>(crossings.hits.size()));
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
        const std::size_t first = crossings.first[ray];
        sort_along_ray(std::span(crossings.hits).subspan(first, crossings.first[ray + 1] - first));
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raypick {

HWY_EXPORT(find_crossings);

void find_crossings(const AccelState& state, std::span<const Ray> rays, const Clearness& clear,
                    Crossings& crossings, const RayQuery& query, const glm::vec3* end) {
    HWY_DYNAMIC_DISPATCH(find_crossings)(state, rays, clear, crossings, query, end);
}

}  // namespace raypick
#endif
