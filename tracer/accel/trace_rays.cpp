#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/trace_rays.cpp"
#include <hwy/foreach_target.h>

#include "tracer/accel/searches.h"
#include "tracer/accel/simd/group_trace-inl.h"
#include "tracer/accel/simd/group_winners-inl.h"
#include "tracer/accel/simd/interleaved-inl.h"
#include "tracer/accel/simd/ray_chunk-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/error.h"

#include <algorithm>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

std::optional<Hit> closest_hit(const AccelState& state, const Ray& any_ray, const RayQuery& query) {
    const Ray ray = from_origin(any_ray);
    ClosestSearch closest(ray.t_max);
    trace_ray(state, ray, query, closest);
    if (!closest.winner().valid()) return std::nullopt;
    if (!closest.ambiguous()) return closest.winner();
    LowestInWindow lowest(closest.limit());
    trace_ray(state, ray, query, lowest);
    return lowest.winner();
}

bool any_hit(const AccelState& state, const Ray& ray, const RayQuery& query) {
    AnySearch any(ray.t_max);
    trace_ray(state, from_origin(ray), query, any);
    return any.found();
}

std::vector<Hit> all_hits(const AccelState& state, const Ray& ray, const RayQuery& query) {
    AllSearch all(ray.t_max);
    trace_ray(state, from_origin(ray), query, all);
    return std::move(all).sorted();
}

namespace {

// The mask's rays are usable.
void closest_one_by_one(const AccelState& state, RayMask mask, std::span<const Ray> rays,
                        std::span<Hit> hits, const RayQuery& query) {
    RayMask ambiguous = 0;
    run_interleaved<ClosestSearch, kInterleaved>(
        [&](Traversal<ClosestSearch>& traversal, std::size_t& ray) HWY_ATTR {
            if (mask == 0) return false;
            ray = take_ray(mask);
            ClosestSearch closest(rays[ray].t_max);
            trace_unbounded(state, rays[ray], query, closest);
            traversal.start(state, rays[ray], query, closest);
            return true;
        },
        [&](const Traversal<ClosestSearch>& traversal, std::size_t ray) HWY_ATTR {
            hits[ray] = traversal.search().winner();
            if (traversal.search().ambiguous()) ambiguous |= RayMask{1} << ray;
        });
    each_ray(ambiguous, [&](std::size_t ray) HWY_ATTR {
        hits[ray] = HWY_NAMESPACE::closest_hit(state, rays[ray], query).value_or(Hit{});
    });
}

RayMask any_one_by_one(const AccelState& state, RayMask mask, std::span<const Ray> rays,
                       const RayQuery& query) {
    RayMask found = 0;
    run_interleaved<AnySearch, kInterleaved>(
        [&](Traversal<AnySearch>& traversal, std::size_t& ray) HWY_ATTR {
            while (mask != 0) {
                ray = take_ray(mask);
                AnySearch any(rays[ray].t_max);
                trace_unbounded(state, rays[ray], query, any);
                if (any.found()) {
                    found |= RayMask{1} << ray;
                    continue;
                }
                traversal.start(state, rays[ray], query, any);
                return true;
            }
            return false;
        },
        [&](const Traversal<AnySearch>& traversal, std::size_t ray) HWY_ATTR {
            if (traversal.search().found()) found |= RayMask{1} << ray;
        });
    return found;
}

void closest_of_chunk(const AccelState& state, std::span<const Ray> rays, std::span<Hit> hits,
                      const RayQuery& query) {
    const Chunk chunk(state, rays, query);
    RayMask alone = chunk.alone;
    RayMask missed = ~RayMask{0};
    for (const RayMask mask : chunk.octants) {
        if (mask == 0) continue;
        ClosestOfGroup search;
        search.limits = chunk.limits;
        search.candidate_from.fill(std::numeric_limits<float>::infinity());
        GroupTrace(state, rays, query, search).run(chunk.world, mask);
        decide_winners(state, search, chunk.world, rays, query, hits);
        alone |= search.lost;
        missed &= ~(search.found | search.rivalled);
    }
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
        if (((missed >> ray) & 1) != 0) hits[ray] = Hit{};
    }
    closest_one_by_one(state, alone, rays, hits, query);
}

// `end`: where the rays end, if it is not null.
void any_of_chunk(const AccelState& state, std::span<const Ray> rays,
                  std::span<std::uint8_t> blocked, const RayQuery& query, const glm::vec3* end) {
    const Chunk chunk(state, rays, query);
    RayMask found = 0;
    for (const RayMask mask : chunk.octants) {
        if (mask == 0) continue;
        AnyOfGroup search;
        search.limits = chunk.limits;
        GroupTrace(state, rays, query, search).run_towards(chunk, mask, end);
        found |= search.blocked;
    }
    found |= any_one_by_one(state, chunk.alone, rays, query);
    for (std::size_t i = 0; i < rays.size(); ++i)
        blocked[i] = static_cast<std::uint8_t>((found >> i) & 1);
}

}  // namespace

void closest_hits(const AccelState& state, std::span<const Ray> rays, std::span<Hit> hits,
                  const RayQuery& query) {
    for (std::size_t i = 0; i < rays.size(); i += kGroup) {
        const std::size_t count = std::min(kGroup, rays.size() - i);
        closest_of_chunk(state, rays.subspan(i, count), hits.subspan(i, count), query);
    }
}

void any_hits(const AccelState& state, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const RayQuery& query, const glm::vec3* end) {
    // Rays backwards from there are of one origin, which is what triangles gain from.
    if (!state.mostly_triangles) end = nullptr;
    for (std::size_t i = 0; i < rays.size(); i += kGroup) {
        const std::size_t count = std::min(kGroup, rays.size() - i);
        any_of_chunk(state, rays.subspan(i, count), blocked.subspan(i, count), query, end);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raypick {

HWY_EXPORT(closest_hit);
HWY_EXPORT(any_hit);
HWY_EXPORT(all_hits);
HWY_EXPORT(closest_hits);
HWY_EXPORT(any_hits);

std::optional<Hit> closest_hit(const AccelState& state, const Ray& ray, const RayQuery& query) {
    return HWY_DYNAMIC_DISPATCH(closest_hit)(state, ray, query);
}

bool any_hit(const AccelState& state, const Ray& ray, const RayQuery& query) {
    return HWY_DYNAMIC_DISPATCH(any_hit)(state, ray, query);
}

std::vector<Hit> all_hits(const AccelState& state, const Ray& ray, const RayQuery& query) {
    return HWY_DYNAMIC_DISPATCH(all_hits)(state, ray, query);
}

void closest_hits(const AccelState& state, std::span<const Ray> rays, std::span<Hit> hits,
                  const RayQuery& query) {
    HWY_DYNAMIC_DISPATCH(closest_hits)(state, rays, hits, query);
}

void any_hits(const AccelState& state, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const RayQuery& query, const glm::vec3* end) {
    HWY_DYNAMIC_DISPATCH(any_hits)(state, rays, blocked, query, end);
}

namespace {

// Whatever was chosen later.
const std::vector<std::int64_t>& targets() {
    static const std::vector<std::int64_t> all = hwy::SupportedAndGeneratedTargets();
    return all;
}

}  // namespace

std::vector<std::string> instruction_sets() {
    std::vector<std::string> names;
    for (const std::int64_t target : targets())
        names.emplace_back(hwy::TargetName(target));
    return names;
}

void use_instruction_set(std::string_view name) {
    std::int64_t wanted = 0;
    std::string known;
    for (const std::int64_t target : targets()) {
        if (name == hwy::TargetName(target)) wanted = target;
        known += std::string(known.empty() ? "" : ", ") + hwy::TargetName(target);
    }
    if (wanted == 0 && !name.empty()) {
        throw Error("there is no instruction set \"" + std::string(name) + "\" here: it can be " +
                    known);
    }
    hwy::SetSupportedTargetsForTest(wanted);
    hwy::GetChosenTarget().DeInit();
}

}  // namespace raypick
#endif
