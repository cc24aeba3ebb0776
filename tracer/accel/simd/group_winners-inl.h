// Which of a group's candidates each ray hits. Included once for each instruction set.
#if defined(RAYPICK_GROUP_WINNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_WINNERS_INL_H
#undef RAYPICK_GROUP_WINNERS_INL_H
#else
#define RAYPICK_GROUP_WINNERS_INL_H
#endif

#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/hit_rows-inl.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/simd/sole_elements-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// The winner by the tie rule of hit.h among what offer_all(search) offers, twice if need be.
template <typename OfferAll>
HWY_INLINE Hit winner_of(float t_max, const OfferAll& offer_all) {
    ClosestSearch closest(t_max);
    offer_all(closest);
    if (!closest.winner().valid() || !closest.ambiguous()) return closest.winner();
    LowestInWindow lowest(closest.limit());
    offer_all(lowest);
    return lowest.winner();
}

// Calls body(object, primitive) for a ray's candidate and its rivals.
template <typename Body>
HWY_INLINE void each_rival(const ClosestOfGroup& search, std::size_t ray, const Body& body) {
    if (((search.found >> ray) & 1) != 0) {
        const Candidate& candidate = search.candidate_of(ray);
        body(candidate.object, candidate.primitive);
    }
    for (std::size_t i = 0; i < search.rival_count; ++i) {
        const RayAndPrimitive& rival = search.rivals[i];
        if (rival.ray == ray) body(rival.object, rival.primitive);
    }
}

// The winner among a ray's candidate and its rivals.
inline Hit choose(const AccelState& state, const ClosestOfGroup& search, std::size_t ray,
                  const Ray& from, const RayQuery& query) {
    return winner_of(from.t_max, [&](auto& one) HWY_ATTR {
        each_rival(search, ray, [&](std::uint32_t object, std::uint32_t primitive) HWY_ATTR {
            trace_primitive(state, object, primitive, from, query, one);
        });
    });
}

// The same of many rays, as far as all that each may hit are triangles of meshes without holes:
// several at once. Each is surely hit, or was found to be, so that it has an area.
class RivalTriangles {
public:
    RivalTriangles(const AccelState& state, const ClosestOfGroup& search, std::span<const Ray> rays,
                   const RayQuery& query)
        : state_(state), search_(search), rays_(rays), query_(query) {}

    // Those that it doesn't decide stay in the mask that it returns.
    HWY_NOINLINE RayMask decide(RayMask mask, std::span<Hit> hits) const {
        RayMask left = 0;
        std::array<Met, kMost> all;
        while (mask != 0) {
            // As many rays as are sure to have room, one after the other.
            std::size_t count = 0;
            RayMask taken = 0;
            for (; mask != 0 && count < kEnough; mask &= mask - 1) {
                const auto ray = static_cast<std::size_t>(std::countr_zero(mask));
                const std::size_t added = gather(ray, all.data() + count);
                (added != 0 ? taken : left) |= RayMask{1} << ray;
                count += added;
            }
            meet({all.data(), count});
            std::span<const Met> rest(all.data(), count);
            each_ray(taken, [&](std::size_t ray) HWY_ATTR {
                std::size_t its_own = 0;
                while (its_own < rest.size() && rest[its_own].ray == ray)
                    ++its_own;
                hits[ray] = winner(ray, rest.first(its_own));
                rest = rest.subspan(its_own);
            });
        }
        return left;
    }

private:
    // A ray with more than that is left to others.
    static constexpr std::size_t kMostOfRay = 8;
    static constexpr std::size_t kEnough = kDoublesAtOnce;
    static constexpr std::size_t kMost = kEnough + kMostOfRay;

    struct Met {
        std::size_t ray;
        std::uint32_t object;  // index
        const Mesh* mesh;
        Hit hit;  // its triangle, and what else there is if it is hit
        bool is_hit;
    };

    // Returns how many; 0 if this isn't for it.
    std::size_t gather(std::size_t ray, Met* to) const {
        std::size_t count = 0;
        bool fine = true;
        each_rival(search_, ray, [&](std::uint32_t object, std::uint32_t primitive) HWY_ATTR {
            const Scene& scene = *state_.scene;
            const auto* mesh = std::get_if<MeshInstance>(&scene.objects[object].shape);
            fine = fine && mesh != nullptr && !state_.instances[object].holes && count < kMostOfRay;
            if (!fine) return;
            Met& met = to[count++];
            met.ray = ray;
            met.object = object;
            met.mesh = &scene.meshes[mesh->mesh];
            met.hit = {scene.objects[object].id, primitive};
        });
        return fine ? count : 0;
    }

    void meet(std::span<Met> all) const {
        TrianglePairs pairs;
        TriangleAnswers answers;
        for (std::size_t first = 0; first < all.size(); first += kDoublesAtOnce) {
            const auto some = all.subspan(first, std::min(kDoublesAtOnce, all.size() - first));
            for (std::size_t lane = 0; lane < some.size(); ++lane) {
                const Met& met = some[lane];
                const glm::uvec3& corner = met.mesh->triangles[met.hit.primitive];
                const auto& positions = met.mesh->positions;
                set_ray(state_.instances[met.object], rays_[met.ray], lane, pairs);
                pairs.set_corners(lane, positions[corner.x], positions[corner.y],
                                  positions[corner.z]);
            }
            pairs.fill_from(some.size());
            HWY_NAMESPACE::decide(TriangleColumns(pairs), answers);
            for (std::size_t lane = 0; lane < some.size(); ++lane)
                set_answer(answers, lane, some[lane]);
        }
    }

    HWY_INLINE void set_answer(const TriangleAnswers& answers, std::size_t lane, Met& met) const {
        const Sides sides = state_.scene->objects[met.object].sides;
        Hit& hit = met.hit;
        hit.front_face = answers.hits_front(lane);
        hit.t = answers.t[lane];
        hit.uv = {answers.u[lane], answers.v[lane]};
        met.is_hit = answers.hits(lane, rays_[met.ray].t_min, rays_[met.ray].t_max) &&
                     shows(sides, hit.front_face) && shows(query_.sides, hit.front_face);
    }

    [[nodiscard]] Hit winner(std::size_t ray, std::span<const Met> its_own) const {
        return winner_of(rays_[ray].t_max, [&](auto& one) HWY_ATTR {
            for (const Met& met : its_own) {
                if (met.is_hit && met.hit.t <= one.limit()) one.offer(met.hit);
            }
        });
    }

    const AccelState& state_;
    const ClosestOfGroup& search_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
};

// Candidates of rays without rivals as far as they are triangles, several at once.
class SoleTriangles {
public:
    // `world` holds the rays, `limits` their intervals as they came.
    SoleTriangles(const AccelState& state, const ClosestOfGroup& search, const GroupRays& world,
                  const GroupLimits& limits, std::span<const Ray> rays, std::span<Hit> hits)
        : state_(state),
          search_(search),
          world_(world),
          limits_(limits),
          rays_(rays),
          hits_(hits) {}

    // Those that it doesn't decide stay in the mask that it returns.
    RayMask decide(RayMask mask) {
        const RayMask others = mask & ~decide_neighbours(in_world(mask));
        decide_rays(
            others,
            [&](std::size_t ray, TrianglePairs& pairs, std::size_t lane)
                HWY_ATTR { return set(ray, pairs, lane); },
            [&](std::size_t ray, const TriangleAnswers& answers, std::size_t lane)
                HWY_ATTR { settle(ray, answers, lane); });
        return left_;
    }

private:
    using Lanes = hn::Rebind<float, Doubles>;
    using Places = hn::Vec<HitNumbers>;
    static constexpr RayMask kAllLanes = (RayMask{1} << kDoublesAtOnce) - 1;

    // Returns those that it was for, which have their hits now or are left for others to decide.
    RayMask decide_neighbours(RayMask mask) {
        RayMask done = 0;
        TriangleAnswers answers;
        for (std::size_t first = 0; first < kGroup; first += kDoublesAtOnce) {
            const RayMask some = (mask >> first) & kAllLanes;
            if (std::popcount(some) < kWorthInPlace) continue;
            done |= some << first;
            const Places places = places_of(first, some);
            decide_in_place(first, places, answers);
            settle_some(first, some, places, answers);
        }
        return done;
    }

    // The mask's rays whose triangle is kept in world space; notes what is hit with the candidates
    // of all. Most rays share candidates, so that these are asked first.
    [[nodiscard]] HWY_INLINE RayMask in_world(RayMask mask) {
        const auto fits = [&](std::uint32_t place) HWY_ATTR {
            const Candidate& candidate = search_.candidates[place];
            objects_[place] = state_.scene->objects[candidate.object].id;
            primitives_[place] = candidate.primitive;
            return candidate.instance != nullptr && candidate.instance->identity;
        };
        bool all_fit = true;
        for (std::uint32_t place = 0; place < search_.candidate_count; ++place)
            all_fit &= fits(place);
        RayMask result = mask;
        each_ray(mask & (all_fit ? search_.in_own_place : ~RayMask{0}),
                 [&](std::size_t ray) HWY_ATTR {
                     if (!fits(search_.candidate[ray])) result &= ~(RayMask{1} << ray);
                 });
        return result;
    }

    // Of the mask's candidates; of lanes that aren't in it, that of one that is.
    [[nodiscard]] HWY_INLINE Places places_of(std::size_t first, RayMask mask) const {
        const HitNumbers d;
        const auto some = static_cast<std::size_t>(std::countr_zero(mask));
        return hn::IfThenElse(mask_of_bits(d, static_cast<std::uint32_t>(mask)),
                              hn::LoadU(d, search_.candidate.data() + first),
                              hn::Set(d, search_.candidate[first + some]));
    }

    HWY_INLINE void decide_in_place(std::size_t first, Places places, TriangleAnswers& answers) {
        const HitNumbers d;
        HWY_ALIGN std::array<std::uint32_t, kDoublesAtOnce> place;
        hn::Store(places, d, place.data());
        if (hn::AllTrue(d, hn::Eq(places, hn::Set(d, place[0])))) {
            const TriangleCorners& corners = search_.candidates[place[0]].corners;
            HWY_NAMESPACE::decide(TriangleColumns(world_, first, corners), answers);
            return;
        }
        CornersOfLanes corners;
        for (std::size_t lane = 0; lane < kDoublesAtOnce; ++lane)
            corners[lane] = &search_.candidates[place[lane]].corners;
        HWY_NAMESPACE::decide(TriangleColumns(world_, first, corners), answers);
    }

    HWY_INLINE void settle_some(std::size_t first, RayMask mask, Places places,
                                const TriangleAnswers& answers) {
        const Lanes d;
        const auto t = hn::Load(d, answers.t.data());
        const auto within = hn::And(hn::Gt(t, hn::LoadU(d, limits_.t_min.data() + first)),
                                    hn::Lt(t, hn::LoadU(d, limits_.t_far.data() + first)));
        const RayMask hit = mask & answers.hit & bits_of_mask(d, within);
        left_ |= (mask & ~hit) << first;
        const HitNumbers numbers;
        const auto index = hn::BitCast(hn::RebindToSigned<HitNumbers>(), places);
        set_hits({hn::GatherIndex(numbers, objects_.data(), index),
                  hn::GatherIndex(numbers, primitives_.data(), index), answers},
                 hit, &hits_[first]);
    }

    HWY_INLINE bool set(std::size_t ray, TrianglePairs& pairs, std::size_t lane) {
        const Candidate& candidate = search_.candidate_of(ray);
        if (candidate.instance != nullptr) {
            set_ray(*candidate.instance, rays_[ray], lane, pairs);
            for (std::size_t k = 0; k < 3; ++k)
                pairs.corners[k][lane] = candidate.corners[k];
            return true;
        }
        const Scene& scene = *state_.scene;
        const auto* instance = std::get_if<MeshInstance>(&scene.objects[candidate.object].shape);
        if (instance == nullptr) {
            left_ |= RayMask{1} << ray;
            return false;
        }
        const Mesh& mesh = scene.meshes[instance->mesh];
        const glm::uvec3 corner = mesh.triangles[candidate.primitive];
        set_ray(state_.instances[candidate.object], rays_[ray], lane, pairs);
        pairs.set_corners(lane, mesh.positions[corner.x], mesh.positions[corner.y],
                          mesh.positions[corner.z]);
        return true;
    }

    HWY_INLINE void settle(std::size_t ray, const TriangleAnswers& answers, std::size_t lane) {
        if (!answers.hits(lane, rays_[ray].t_min, rays_[ray].t_max)) {
            left_ |= RayMask{1} << ray;
            return;
        }
        const Candidate& candidate = search_.candidate_of(ray);
        hits_[ray] = {state_.scene->objects[candidate.object].id,
                      candidate.primitive,
                      answers.t[lane],
                      {answers.u[lane], answers.v[lane]},
                      answers.hits_front(lane)};
    }

    const AccelState& state_;
    const ClosestOfGroup& search_;
    const GroupRays& world_;
    const GroupLimits& limits_;
    std::span<const Ray> rays_;
    std::span<Hit> hits_;
    RayMask left_ = 0;
    // By candidate.
    HWY_ALIGN std::array<std::uint32_t, ClosestOfGroup::kPlaces> objects_;  // ids
    HWY_ALIGN std::array<std::uint32_t, ClosestOfGroup::kPlaces> primitives_;
};

// The hits of all rays that found something and aren't lost. `world` holds the rays, `limits` their
// intervals as they came.
inline void decide_winners(const AccelState& state, const ClosestOfGroup& search,
                           const GroupRays& world, const GroupLimits& limits,
                           std::span<const Ray> rays, const RayQuery& query, std::span<Hit> hits) {
    const RayMask sole = search.found & ~search.rivalled;
    const RayMask elements = SoleTriangles(state, search, world, limits, rays, hits).decide(sole);
    const RayMask rivalled = search.rivalled & ~search.lost;
    RayMask open = 0;
    if (rivalled != 0) open = RivalTriangles(state, search, rays, query).decide(rivalled, hits);
    open |= decide_sole_elements(state, search, elements, world, rays, query, hits);
    each_ray(open, [&](std::size_t ray)
                       HWY_ATTR { hits[ray] = choose(state, search, ray, rays[ray], query); });
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
