// What follows for a group's rays from what float bounds say of a primitive. Included once for each
// instruction set.
#if defined(RAYPICK_GROUP_SETTLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_SETTLE_INL_H
#undef RAYPICK_GROUP_SETTLE_INL_H
#else
#define RAYPICK_GROUP_SETTLE_INL_H
#endif

#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/group_cones-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/group_spheres-inl.h"
#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/open_elements-inl.h"
#include "tracer/accel/simd/ray_patches-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// Whose a patch's triangles are, and which sides of them count.
struct Searched {
    std::uint32_t object = 0;
    ShownSides shown{false, false};
};

// `Group` is ClosestOfGroup, AnyOfGroup or CrossingsOfGroup.
template <typename Group>
class GroupSettle {
public:
    GroupSettle(const AccelState& state, std::span<const Ray> rays, const RayQuery& query,
                Group& search)
        : state_(state),
          rays_(rays),
          query_(query),
          search_(search),
          open_(state, rays, query, search) {}

    // What was found of the mask's `bits` in the vector of rays from `ray` on.
    template <typename Shape>
    HWY_NOINLINE void settle(const GroupSpace& space, const Verdict& verdict, std::size_t ray,
                             RayMask bits, Taken<Shape>& taken) {
        RayMask open = 0;
        if constexpr (std::is_same_v<Group, ClosestOfGroup>) {
            open = take(search_, verdict, ray, bits, taken) << ray;
        } else {
            const RayMask sure = taken.instance.holes ? 0 : verdict.sure & bits;
            search_.block(sure << ray);
            open = (verdict.may & bits & ~sure) << ray;
        }
        if (open != 0) {
            settle_open(space, taken.instance, taken.object, taken.shape, taken.primitive, open);
        }
    }

    // All triangles of a patch with one ray after the other.
    void judge_patch(const Searched& searched, const GroupSpace& space,
                     const GroupTriangles& triangles, const TrianglePatch& patch, RayMask mask) {
        PatchNotes notes;
        // First what all rays do, then what few do and can't be foretold: so one ray's work begins
        // before the other's ends.
        constexpr std::size_t kSome = 8;
        std::array<RayVerdict, kSome + 1> verdicts;
        std::array<std::size_t, kSome + 1> met;
        while (mask != 0) {
            std::size_t count = 0;
            for (std::size_t i = 0; i < kSome && mask != 0; ++i, mask &= mask - 1) {
                const auto ray = static_cast<std::size_t>(std::countr_zero(mask));
                judge_patch_of_ray(space, search_.limits, ray, triangles, patch.triangles,
                                   searched.shown, verdicts[count]);
                met[count] = ray;
                count += verdicts[count].may != 0 ? 1u : 0u;
            }
            for (std::size_t i = 0; i < count; ++i)
                settle_ray(searched.object, triangles, patch, met[i], verdicts[i], notes);
        }
        for (std::size_t i = 0; i < patch.triangles; ++i) {
            if (notes.open[i] == 0) continue;
            settle_open(space, state_.instances[searched.object], searched.object,
                        GroupTriangle{triangles, patch, i}, patch.primitives()[i], notes.open[i]);
        }
    }

    // What waited for more of its kind. Called in the end.
    void decide_last() { open_.decide_last(); }

private:
    // Of a patch's triangles.
    struct PatchNotes {
        std::array<std::uint32_t, TrianglePatch::kMostTriangles> places;  // see Taken
        std::array<RayMask, TrianglePatch::kMostTriangles> open{};        // rays that may hit it

        PatchNotes() { places.fill(ClosestOfGroup::kMostCandidates); }
    };

    void settle_ray(std::uint32_t object, const GroupTriangles& triangles,
                    const TrianglePatch& patch, std::size_t ray, const RayVerdict& verdict,
                    PatchNotes& notes) {
        const Instance& instance = state_.instances[object];
        const RayMask bit = RayMask{1} << ray;
        const std::uint32_t may = not_crossed(search_, object, patch, verdict.may, ray);
        const std::uint32_t sure = instance.holes ? 0u : verdict.sure & may;
        if constexpr (std::is_same_v<Group, ClosestOfGroup>) {
            each_bit(sure, [&](std::size_t i) HWY_ATTR {
                const GroupTriangle triangle{triangles, patch, i};
                Taken<GroupTriangle> taken{triangle, instance, object, patch.primitives()[i],
                                           notes.places[i]};
                take_one(search_, ray, verdict.from[i], verdict.to[i], taken);
                notes.places[i] = taken.place;
            });
        } else if (sure != 0) {
            search_.block(bit);
            return;
        }
        each_bit(may & ~sure, [&](std::size_t i) { notes.open[i] |= bit; });
    }

    // The bounds leave open whether the mask's rays hit.
    template <typename Shape>
    void settle_open(const GroupSpace& space, const Instance& instance, std::uint32_t object,
                     const Shape& shape, std::uint32_t primitive, RayMask mask) {
        if constexpr (std::is_same_v<Shape, GroupTriangle>) {
            if (!instance.holes) {
                decide_open(space, object, shape, primitive, mask);
                return;
            }
        } else if (!instance.holes) {
            each_ray(mask, [&](std::size_t i) HWY_ATTR {
                open_.template add<typename Shape::Set>(
                    {static_cast<std::uint32_t>(i), object, primitive});
            });
            return;
        }
        if constexpr (std::is_same_v<Group, ClosestOfGroup>) {
            each_ray(mask,
                     [&](std::size_t i) HWY_ATTR { search_.add_rival(i, object, primitive); });
        } else {
            each_ray(mask, [&](std::size_t i) HWY_ATTR {
                AnyOfOne one{search_, i};
                trace_primitive(state_, object, primitive, rays_[i], query_, one);
            });
        }
    }

    // Rays that the bounds leave open, as all do that begin on the triangle itself.
    void decide_open(const GroupSpace& space, std::uint32_t object, const GroupTriangle& triangle,
                     std::uint32_t primitive, RayMask mask) {
        TriangleCorners corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = triangle.patch.position(static_cast<std::uint32_t>(triangle.i),
                                                        static_cast<int>(k));
            corners[k] = {p.x, p.y, p.z, 0.0f};
        }
        if (!has_area(glm::vec3(corners[0][0], corners[0][1], corners[0][2]),
                      glm::vec3(corners[1][0], corners[1][1], corners[1][2]),
                      glm::vec3(corners[2][0], corners[2][1], corners[2][2])))
            return;
        const Instance& instance = state_.instances[object];
        const auto settle_one =
            [&](std::size_t ray, const TriangleAnswers& answers, std::size_t lane)
                HWY_ATTR { offer_open(object, primitive, ray, answers, lane); };
        if (instance.identity) {
            decide_alike(space.course.backwards() ? *space.course.forward : space.rays, mask,
                         corners, settle_one);
            return;
        }
        decide_rays(
            mask,
            [&](std::size_t ray, TrianglePairs& pairs, std::size_t lane) HWY_ATTR {
                pairs.set_ray(lane, object_ray(instance, rays_[ray]));
                for (std::size_t k = 0; k < 3; ++k)
                    pairs.corners[k][lane] = corners[k];
                return true;
            },
            settle_one);
    }

    HWY_INLINE void offer_open(std::uint32_t index, std::uint32_t primitive, std::size_t ray,
                               const TriangleAnswers& answers, std::size_t lane) {
        if (!answers.hits(lane, rays_[ray].t_min, rays_[ray].t_max)) return;
        const bool front = answers.hits_front(lane);
        const Object& object = state_.scene->objects[index];
        if (!shows(object.sides, front) || !shows(query_.sides, front)) return;
        offer_hit(search_, ray, index, primitive, answers.t[lane]);
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    Group& search_;
    OpenOfGroup<Group> open_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
