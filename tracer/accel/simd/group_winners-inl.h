// Which of a group's candidates each ray hits. Included once for each instruction set.
#if defined(RAYPICK_GROUP_WINNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_WINNERS_INL_H
#undef RAYPICK_GROUP_WINNERS_INL_H
#else
#define RAYPICK_GROUP_WINNERS_INL_H
#endif

#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/simd/sole_elements-inl.h"

#include <span>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// The winner among a ray's candidate and its rivals by the tie rule of hit.h.
inline void choose(const AccelState& state, const ClosestOfGroup& search, std::size_t ray,
                   const Ray& from, const RayQuery& query, Hit& hit) {
    const auto offer_all = [&](auto& one) HWY_ATTR {
        if (((search.found >> ray) & 1) != 0) {
            const Candidate& candidate = search.candidate_of(ray);
            trace_primitive(state, candidate.object, candidate.primitive, from, query, one);
        }
        for (std::size_t i = 0; i < search.rival_count; ++i) {
            const RayAndPrimitive& rival = search.rivals[i];
            if (rival.ray != ray) continue;
            trace_primitive(state, rival.object, rival.primitive, from, query, one);
        }
    };
    ClosestSearch closest(from.t_max);
    offer_all(closest);
    if (!closest.winner().valid() || !closest.ambiguous()) {
        hit = closest.winner();
        return;
    }
    LowestInWindow lowest(closest.limit());
    offer_all(lowest);
    hit = lowest.winner();
}

// Candidates of rays without rivals as far as they are triangles, several at once.
class SoleTriangles {
public:
    // `world` holds the rays.
    SoleTriangles(const AccelState& state, const ClosestOfGroup& search, const GroupRays& world,
                  std::span<const Ray> rays, std::span<Hit> hits)
        : state_(state), search_(search), world_(world), rays_(rays), hits_(hits) {}

    // Those that it doesn't decide stay in the mask that it returns.
    RayMask decide(RayMask mask) {
        const RayMask others = decide_neighbours(mask);
        decide_rays(
            others,
            [&](std::size_t ray, TrianglePairs& pairs, std::size_t lane)
                HWY_ATTR { return set(ray, pairs, lane); },
            [&](std::size_t ray, const TriangleAnswers& answers, std::size_t lane)
                HWY_ATTR { settle(ray, answers, lane); });
        return left_;
    }

private:
    // Returns the others.
    RayMask decide_neighbours(RayMask mask) {
        constexpr RayMask kSome = (RayMask{1} << kDoublesAtOnce) - 1;
        RayMask others = mask;
        TriangleAnswers answers;
        for (std::size_t first = 0; first < kGroup; first += kDoublesAtOnce) {
            const RayMask some = in_world(first, (mask >> first) & kSome);
            if (std::popcount(some) < kWorthInPlace) continue;
            others &= ~(some << first);
            decide_in_place(first, some, answers);
            each_ray(some, [&](std::size_t lane) HWY_ATTR { settle(first + lane, answers, lane); });
        }
        return others;
    }

    // Of the mask's rays, counted from `first` on, those whose triangle is kept in world space.
    [[nodiscard]] HWY_INLINE RayMask in_world(std::size_t first, RayMask mask) const {
        RayMask result = mask;
        each_ray(mask, [&](std::size_t lane) HWY_ATTR {
            const Instance* instance = search_.candidate_of(first + lane).instance;
            if (instance == nullptr || !instance->identity) result &= ~(RayMask{1} << lane);
        });
        return result;
    }

    HWY_INLINE void decide_in_place(std::size_t first, RayMask mask, TriangleAnswers& answers) {
        const auto some = static_cast<std::size_t>(std::countr_zero(mask));
        const Candidate& one = search_.candidate_of(first + some);
        bool alike = true;
        each_ray(mask, [&](std::size_t lane)
                           HWY_ATTR { alike &= &search_.candidate_of(first + lane) == &one; });
        if (alike) {
            HWY_NAMESPACE::decide(TriangleColumns(world_, first, one.corners), answers);
            return;
        }
        for (std::size_t lane = 0; lane < kDoublesAtOnce; ++lane) {
            const bool is_there = ((mask >> lane) & 1) != 0;
            const Candidate& candidate = is_there ? search_.candidate_of(first + lane) : one;
            for (std::size_t k = 0; k < 3; ++k)
                corners_[k][lane] = candidate.corners[k];
        }
        HWY_NAMESPACE::decide(TriangleColumns(world_, first, corners_), answers);
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
    std::span<const Ray> rays_;
    std::span<Hit> hits_;
    HWY_ALIGN TrianglePairs::CornerRows corners_;  // of decide_in_place
    RayMask left_ = 0;
};

// The hits of all rays that found something and aren't lost. `world` holds the rays.
inline void decide_winners(const AccelState& state, const ClosestOfGroup& search,
                           const GroupRays& world, std::span<const Ray> rays, const RayQuery& query,
                           std::span<Hit> hits) {
    const RayMask sole = search.found & ~search.rivalled;
    const RayMask elements = SoleTriangles(state, search, world, rays, hits).decide(sole);
    RayMask open = search.rivalled & ~search.lost;
    open |= decide_sole_elements(state, search, elements, world, rays, query, hits);
    each_ray(open, [&](std::size_t ray)
                       HWY_ATTR { choose(state, search, ray, rays[ray], query, hits[ray]); });
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
