#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/trace_rays.cpp"
#include <hwy/foreach_target.h>

#include "tracer/accel/searches.h"
#include "tracer/accel/simd/group_trace-inl.h"
#include "tracer/accel/simd/group_winners-inl.h"
#include "tracer/accel/simd/hit_rows-inl.h"
#include "tracer/accel/simd/ray_chunk-inl.h"
#include "tracer/accel/simd/ray_run-inl.h"
#include "tracer/accel/simd/rays_apart-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/error.h"

#include <algorithm>
#include <optional>
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

// Fewer rays than that are quicker one by one.
constexpr std::size_t kFewestInChunk = 4;

// Calls body(first, count, run) for one chunk of rays after the other, and returns where there are
// too few left for one. The processor is told of the next while one is followed: by itself it
// foresees no further than to the end of a page. `end`: see RayRun.
template <typename Body>
HWY_INLINE std::size_t each_chunk(const AccelState& state, std::span<const Ray> rays,
                                  const glm::vec3* end, const Body& body) {
    constexpr std::size_t kRaysInLine = 64 / sizeof(Ray);
    std::optional<RayRun> run;
    std::size_t first = 0;
    while (rays.size() - first >= kFewestInChunk) {
        const std::size_t count = std::min(kGroup, rays.size() - first);
        const std::size_t next = first + count;
        if (first % RayRun::kMostRays == 0) run.emplace(state, rays_of_run(rays, first), end);
        for (std::size_t i = next; i < std::min(next + kGroup, rays.size()); i += kRaysInLine)
            __builtin_prefetch(&rays[i]);
        body(first, count, *run);
        first = next;
    }
    return first;
}

void closest_of_chunk(const AccelState& state, std::span<const Ray> rays, std::span<Hit> hits,
                      const RayQuery& query, RayRun& run) {
    const Chunk chunk(state, rays, query);
    RayMask alone = chunk.alone;
    RayMask missed = first_rays(rays.size());
    const auto find = [&](const auto& follow) HWY_ATTR {
        ClosestOfGroup search;
        search.limits = chunk.limits;
        search.candidate_from.fill(std::numeric_limits<float>::infinity());
        follow(search);
        decide_winners(state, search, chunk.world, chunk.limits, rays, query, hits);
        alone |= search.lost;
        missed &= ~(search.found | search.rivalled);
    };
    for (const RayMask mask : chunk.octants) {
        if (mask == 0) continue;
        find([&](ClosestOfGroup& search)
                 HWY_ATTR { GroupTrace(state, rays, query, run, search).run(chunk.world, mask); });
    }
    if (chunk.apart != 0) {
        find([&](ClosestOfGroup& search)
                 HWY_ATTR { RaysApart(state, rays, query, search).run(chunk.apart); });
    }
    set_missed(missed, hits.data());
    each_ray(alone, [&](std::size_t ray) HWY_ATTR {
        hits[ray] = HWY_NAMESPACE::closest_hit(state, rays[ray], query).value_or(Hit{});
    });
}

// `end`: where the rays end, if it is not null. `blockers`: of the chunks before; takes this one's.
void any_of_chunk(const AccelState& state, std::span<const Ray> rays,
                  std::span<std::uint8_t> blocked, const RayQuery& query, const glm::vec3* end,
                  Blockers& blockers, RayRun& run) {
    const Chunk chunk(state, rays, query);
    RayMask found = 0;
    const auto find = [&](const auto& follow) HWY_ATTR {
        AnyOfGroup search;
        search.limits = chunk.limits;
        search.blockers = &blockers;
        follow(search);
        found |= search.blocked;
    };
    for (const RayMask mask : chunk.octants) {
        if (mask == 0) continue;
        find([&](AnyOfGroup& search) HWY_ATTR {
            GroupTrace(state, rays, query, run, search).run_towards(chunk, mask, end);
        });
    }
    if (chunk.apart != 0) {
        find([&](AnyOfGroup& search)
                 HWY_ATTR { RaysApart(state, rays, query, search).run(chunk.apart); });
    }
    each_ray(chunk.alone, [&](std::size_t ray) HWY_ATTR {
        if (HWY_NAMESPACE::any_hit(state, rays[ray], query)) found |= RayMask{1} << ray;
    });
    for (std::size_t i = 0; i < rays.size(); ++i)
        blocked[i] = static_cast<std::uint8_t>((found >> i) & 1);
}

}  // namespace

void closest_hits(const AccelState& state, std::span<const Ray> rays, std::span<Hit> hits,
                  const RayQuery& query) {
    const auto follow = [&](std::size_t first, std::size_t count, RayRun& run) HWY_ATTR {
        closest_of_chunk(state, rays.subspan(first, count), hits.subspan(first, count), query, run);
    };
    std::size_t i = each_chunk(state, rays, nullptr, follow);
    for (; i < rays.size(); ++i)
        hits[i] = HWY_NAMESPACE::closest_hit(state, rays[i], query).value_or(Hit{});
}

void any_hits(const AccelState& state, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const RayQuery& query, const glm::vec3* end) {
    // Rays backwards from there are of one origin, which is what triangles gain from.
    if (!state.mostly_triangles) end = nullptr;
    Blockers blockers;
    const auto follow = [&](std::size_t first, std::size_t count, RayRun& run) HWY_ATTR {
        any_of_chunk(state, rays.subspan(first, count), blocked.subspan(first, count), query, end,
                     blockers, run);
    };
    std::size_t i = each_chunk(state, rays, end, follow);
    for (; i < rays.size(); ++i)
        blocked[i] = HWY_NAMESPACE::any_hit(state, rays[i], query) ? 1 : 0;
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
