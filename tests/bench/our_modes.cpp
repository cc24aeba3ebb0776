#include "tests/bench/crew.h"
#include "tests/bench/modes.h"

#include <algorithm>
#include <array>

namespace raypick::bench {

namespace {

// Where one worker's answers go; small enough to stay in the cache.
struct Answers {
    std::vector<Hit> hits = std::vector<Hit>(kPiece);
    std::vector<std::uint8_t> blocked = std::vector<std::uint8_t>(kPiece);
};
using AllAnswers = std::array<Answers, kMostWorkers>;

Tally tally(std::span<const Hit> hits) {
    Tally sum;
    for (const Hit& hit : hits) {
        if (hit.valid()) sum += {1, static_cast<double>(hit.t)};
    }
    return sum;
}

// Triangles have their barycentric coordinates whatever a query asks for, as Embree's have. Nobody
// works out those of its spheres and cones.
RayQuery as_embree_answers() {
    RayQuery query;
    query.uv = false;
    return query;
}

// The one call for shadow rays of a light.
void trace_shadows(const Accel& accel, const RayList& list, std::span<const Ray> rays,
                   std::span<std::uint8_t> blocked) {
    accel.occluded_towards(glm::vec3(list.light), rays, blocked);
}

Mode closest_batch(const Accel& accel, const RayList& list) {
    const auto answers = std::make_shared<AllAnswers>();
    return {"batch", true,
            [&accel, list, answers, query = as_embree_answers()](
                std::size_t worker, std::size_t begin, std::size_t end) {
                const std::span<Hit> hits = std::span((*answers)[worker].hits).first(end - begin);
                accel.intersect(list.rays.subspan(begin, end - begin), hits, query);
                return tally(hits);
            }};
}

Mode any_batch(const Accel& accel, const RayList& list) {
    const auto answers = std::make_shared<AllAnswers>();
    return {"batch", true,
            [&accel, list, answers](std::size_t worker, std::size_t begin, std::size_t end) {
                const auto blocked = std::span((*answers)[worker].blocked).first(end - begin);
                trace_shadows(accel, list, list.rays.subspan(begin, end - begin), blocked);
                const auto hits = std::count(blocked.begin(), blocked.end(), std::uint8_t{1});
                return Tally{static_cast<std::size_t>(hits), 0.0};
            }};
}

Mode closest_single(const Accel& accel, const RayList& list) {
    return {"single", true,
            [&accel, list, query = as_embree_answers()](std::size_t, std::size_t begin,
                                                        std::size_t end) {
                Tally sum;
                for (std::size_t i = begin; i < end; ++i) {
                    const auto hit = accel.intersect(list.rays[i], query);
                    if (hit) sum += {1, static_cast<double>(hit->t)};
                }
                return sum;
            }};
}

Mode any_single(const Accel& accel, const RayList& list) {
    return {"single", true, [&accel, list](std::size_t, std::size_t begin, std::size_t end) {
                Tally sum;
                for (std::size_t i = begin; i < end; ++i)
                    sum.hits += accel.occluded(list.rays[i]) ? 1 : 0;
                return sum;
            }};
}

}  // namespace

Tally run(const Mode& mode, std::size_t count, int threads) {
    std::array<Tally, kMostWorkers> tallies{};
    share_out((count + kPiece - 1) / kPiece, threads, [&](std::size_t worker, std::size_t piece) {
        const std::size_t begin = piece * kPiece;
        tallies[worker] += mode.trace(worker, begin, std::min(count, begin + kPiece));
    });
    Tally sum;
    for (const Tally& tally : tallies)
        sum += tally;
    return sum;
}

std::vector<Mode> our_modes(const Accel& accel, const RayList& list) {
    if (list.any_hit) return {any_batch(accel, list), any_single(accel, list)};
    return {closest_batch(accel, list), closest_single(accel, list)};
}

}  // namespace raypick::bench
