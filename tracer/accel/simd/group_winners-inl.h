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
            trace_primitive(state, search.candidate_object[ray], search.candidate_primitive[ray],
                            from, query, one);
        }
        for (std::size_t i = 0; i < search.rival_count; ++i) {
            const ClosestOfGroup::Rival& rival = search.rivals[i];
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

// The candidates of rays without rivals as far as they are triangles, several at once; the other
// rays stay in the mask that it returns.
inline RayMask decide_sole_triangles(const AccelState& state, const ClosestOfGroup& search,
                                     RayMask mask, std::span<const Ray> rays, std::span<Hit> hits) {
    const Scene& scene = *state.scene;
    RayMask left = 0;
    decide_rays(
        mask,
        [&](std::size_t ray, TrianglePairs& pairs, std::size_t lane) HWY_ATTR {
            const std::uint32_t object = search.candidate_object[ray];
            const auto* instance = std::get_if<MeshInstance>(&scene.objects[object].shape);
            if (instance == nullptr) {
                left |= RayMask{1} << ray;
                return false;
            }
            const Mesh& mesh = scene.meshes[instance->mesh];
            const glm::uvec3 corner = mesh.triangles[search.candidate_primitive[ray]];
            const ObjectRay local = object_ray(state.instances[object], rays[ray]);
            pairs.set(lane, local.origin, local.direction, mesh.positions[corner.x],
                      mesh.positions[corner.y], mesh.positions[corner.z]);
            return true;
        },
        [&](std::size_t ray, const TriangleAnswers& answers, std::size_t lane) HWY_ATTR {
            if (!answers.hits(lane, rays[ray].t_min, rays[ray].t_max)) {
                left |= RayMask{1} << ray;
                return;
            }
            hits[ray] = {scene.objects[search.candidate_object[ray]].id,
                         search.candidate_primitive[ray],
                         static_cast<float>(answers.t[lane]),
                         {static_cast<float>(answers.u[lane]), static_cast<float>(answers.v[lane])},
                         answers.determinant[lane] > 0.0};
        });
    return left;
}

// The hits of all rays that found something and aren't lost.
inline void decide_winners(const AccelState& state, const ClosestOfGroup& search,
                           std::span<const Ray> rays, const RayQuery& query, std::span<Hit> hits) {
    const RayMask sole = search.found & ~search.rivalled;
    const RayMask elements = decide_sole_triangles(state, search, sole, rays, hits);
    RayMask open = search.rivalled & ~search.lost;
    open |= decide_sole_elements(state, search, elements, rays, query, hits);
    each_ray(open, [&](std::size_t ray)
                       HWY_ATTR { choose(state, search, ray, rays[ray], query, hits[ray]); });
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
