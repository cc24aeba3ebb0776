// A group of rays through the objects of a scene. Included once for each instruction set.
#if defined(RAYPICK_GROUP_TRACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_TRACE_INL_H
#undef RAYPICK_GROUP_TRACE_INL_H
#else
#define RAYPICK_GROUP_TRACE_INL_H
#endif

#include "tracer/accel/simd/decide_rectangles-inl.h"
#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/group_back-inl.h"
#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/accel/simd/group_cones-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/group_spheres-inl.h"
#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/interleaved-inl.h"
#include "tracer/accel/simd/open_elements-inl.h"
#include "tracer/accel/simd/ray_patches-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"

#include <cstddef>
#include <span>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// `Group` is ClosestOfGroup, AnyOfGroup or CrossingsOfGroup.
template <typename Group>
class GroupTrace {
public:
    GroupTrace(const AccelState& state, std::span<const Ray> rays, const RayQuery& query,
               Group& search)
        : state_(state),
          rays_(rays),
          query_(query),
          search_(search),
          open_spheres_(state, rays, query),
          open_cones_(state, rays, query) {}

    // The rays of the mask, all usable, in one octant and with t_min >= 0; `world` holds them.
    void run(const GroupRays& group, RayMask mask) {
        for (const std::uint32_t object : state_.unbounded)
            each_on_its_own({object, {}}, mask);
        if (state_.top.empty()) return;
        enter_world(GroupSpace(group, mask, 0.0f, state_.reach), mask);
        decide_last();
    }

    // The same backwards.
    void run_back(const GroupBack& back, RayMask mask) {
        for (const std::uint32_t object : state_.unbounded)
            each_on_its_own({object, {}}, mask);
        if (state_.top.empty()) return;
        enter_world(GroupSpace(back.rays, mask, 0.0f, state_.reach, back.course), mask);
        decide_last();
    }

private:
    void enter_world(const GroupSpace& world, RayMask mask) {
        walk_group(
            state_.top, state_.top.root, world, search_.limits_in(world), mask,
            [&](const WideRef& leaf, RayMask met) HWY_ATTR {
                each_index(state_.top, leaf, [&](std::uint32_t entry) HWY_ATTR {
                    enter(state_.entries[entry], world, met);
                    return false;
                });
            },
            [&](const WideRef& part, RayMask met) HWY_ATTR { finish_top(part, met); });
    }

    // What is left of the top tree, ray by ray.
    void finish_top(const WideRef& part, RayMask mask) {
        each_ray(mask, [&](std::size_t ray) HWY_ATTR {
            RayInSpace world(rays_[ray], state_.reach);
            walk(
                state_.top, part, world.slabs(), rays_[ray].t_min,
                [&]() HWY_ATTR { return search_.limits.t_far[ray]; },
                [&](const WideRef& leaf) HWY_ATTR {
                    return each_index(state_.top, leaf, [&](std::uint32_t number) HWY_ATTR {
                        const TopEntry& entry = state_.entries[number];
                        auto one = one_of(search_, ray, entry.object);
                        return trace_entry(state_, entry, rays_[ray], world, query_, one);
                    });
                });
        });
    }

    void each_on_its_own(const TopEntry& entry, RayMask mask) {
        each_ray(mask, [&](std::size_t ray) HWY_ATTR {
            auto one = one_of(search_, ray, entry.object);
            if (state_.instances[entry.object].tree == nullptr) {
                trace_simple(state_, entry.object, rays_[ray], query_, one);
                return;
            }
            RayInSpace world(rays_[ray], state_.reach);
            trace_entry(state_, entry, rays_[ray], world, query_, one);
        });
    }

    // The same for a few rays in a mesh or a part of it.
    void few_in_mesh(const TopEntry& entry, RayMask mask) {
        using One = decltype(one_of(search_, 0, 0));
        run_interleaved<One, kFewRays>(
            [&](Traversal<One>& traversal, std::size_t&) HWY_ATTR {
                if (mask == 0) return false;
                const auto ray = static_cast<std::size_t>(std::countr_zero(mask));
                mask &= mask - 1;
                traversal.start_in(state_, entry, rays_[ray], query_,
                                   one_of(search_, ray, entry.object));
                return true;
            },
            [](const Traversal<One>&, std::size_t) {});
    }

    void enter(const TopEntry& entry, const GroupSpace& world, RayMask mask) {
        const Instance& instance = state_.instances[entry.object];
        if (instance.joined()) {
            enter_joined(entry, world, mask);
            return;
        }
        const Object& object = state_.scene->objects[entry.object];
        if ((object.mask & query_.mask) == 0) return;
        if (const auto* rectangle = std::get_if<Rectangle>(&object.shape)) {
            enter_rectangle(entry.object, *rectangle, world, mask);
            return;
        }
        const bool in_groups = std::holds_alternative<MeshInstance>(object.shape) ||
                               std::holds_alternative<SphereSetInstance>(object.shape) ||
                               std::holds_alternative<ConeSetInstance>(object.shape);
        const float reach = in_groups ? instance.tree->reach : 0.0f;
        if (!in_groups || !(reach < kFarthestReach)) {
            each_on_its_own(entry, mask);
            return;
        }
        if (world.course.backwards() && !std::holds_alternative<MeshInstance>(object.shape)) {
            enter(entry, GroupSpace(*world.course.forward, mask, 0.0f, state_.reach), mask);
            return;
        }
        if (instance.identity) {
            enter_tree(entry, world, mask);
            return;
        }
        enter_placed(entry, world, mask, reach);
    }

    // The joined tree, or a part of it.
    void enter_joined(const TopEntry& entry, const GroupSpace& world, RayMask mask) {
        const Instance& joined = state_.instances[entry.object];
        if (!(joined.tree->reach < kFarthestReach)) {
            each_on_its_own(entry, mask);
            return;
        }
        search_mesh(entry, world, mask, [&](const TrianglePatch& patch) HWY_ATTR {
            const std::uint32_t index = joined.members[patch.member].object;
            if (index == kNobody) return Searched{};
            const Object& object = state_.scene->objects[index];
            if ((object.mask & query_.mask) == 0) return Searched{};
            return Searched{index, shown_to(world, object)};
        });
    }

    // A few rays at once, of which each is decided at once.
    void enter_rectangle(std::uint32_t index, const Rectangle& rectangle, const GroupSpace& world,
                         RayMask mask) {
        const Instance& instance = state_.instances[index];
        if (instance.holes) {
            each_on_its_own({index, {}}, mask);
            return;
        }
        const GroupRays& rays = world.course.backwards() ? *world.course.forward : world.rays;
        constexpr RayMask kSome = (RayMask{1} << kDoublesAtOnce) - 1;
        for (std::size_t first = 0; first < kGroup; first += kDoublesAtOnce) {
            const RayMask some = (mask >> first) & kSome;
            if (some == 0) continue;
            if (instance.identity) {
                offer_rectangle(index, RectanglesDecided(rays, first, rectangle), first, some);
                continue;
            }
            RectanglePairs pairs;
            pairs.fill_from(0);
            each_ray(some, [&](std::size_t lane) HWY_ATTR {
                pairs.set(lane, object_ray(instance, rays_[first + lane]), rectangle);
            });
            offer_rectangle(index, RectanglesDecided(pairs), first, some);
        }
    }

    // To the rays of the mask, counted from `first` on.
    HWY_INLINE void offer_rectangle(std::uint32_t index, const RectanglesDecided& decided,
                                    std::size_t first, RayMask mask) {
        const Object& object = state_.scene->objects[index];
        const auto seen = [&](bool front) HWY_ATTR {
            return shows(object.sides, front) && shows(query_.sides, front);
        };
        const std::uint32_t shown =
            (seen(true) ? decided.front : 0u) | (seen(false) ? ~decided.front : 0u);
        each_ray(mask & decided.ordinary & shown, [&](std::size_t lane) HWY_ATTR {
            const std::size_t ray = first + lane;
            const auto t = static_cast<float>(decided.enters_at[lane]);
            if (t > rays_[ray].t_min && t < rays_[ray].t_max) offer(ray, index, 0, t);
        });
    }

    // A mesh or a set with a space of its own.
    void enter_placed(const TopEntry& entry, const GroupSpace& world, RayMask mask, float reach) {
        const Instance& instance = state_.instances[entry.object];
        GroupRays forward{};
        each_ray(mask, [&](std::size_t ray)
                           HWY_ATTR { forward.set(ray, object_ray(instance, rays_[ray])); });
        forward.invert();
        GroupRays back;  // NOLINT: not initialised, as it is large
        GroupCourse course = world.course;
        if (course.backwards()) {
            const glm::vec3 end(world.origin_low[0], world.origin_low[1], world.origin_low[2]);
            back.set_backwards(forward,
                               glm::vec3(instance.object_from_world.point(glm::dvec3(end))));
            course = course_in_object(course, instance.object_from_world, forward);
        }
        const GroupRays& turned = course.backwards() ? back : forward;
        // An instance of another scale may leave nothing of a ray that float can hold.
        const RayMask ordinary = mask & forward.within(kFarthestReach, 1e-6f, 1e6f) &
                                 turned.within(kFarthestReach, 1e-6f, 1e6f);
        each_on_its_own(entry, mask & ~ordinary);
        // Rays of one octant may lie in several here.
        for (const RayMask same : turned.octants(ordinary)) {
            if (std::popcount(same) <= kFewRays) {
                each_on_its_own(entry, same);
            } else {
                enter_tree(entry, GroupSpace(turned, same, instance.slop, reach, course), same);
            }
        }
    }

    void enter_tree(const TopEntry& entry, const GroupSpace& space, RayMask mask) {
        const Object& object = state_.scene->objects[entry.object];
        const ShownSides shown = shown_to(space, object);
        if (!shown.any()) return;
        const PrimitiveTree& tree = *state_.instances[entry.object].tree;
        if (std::holds_alternative<MeshInstance>(object.shape)) {
            search_mesh(entry, space, mask, [&](const TrianglePatch& /*patch*/) HWY_ATTR {
                return Searched{entry.object, shown};
            });
        } else if (const auto* cones = std::get_if<ConeSetInstance>(&object.shape)) {
            const ConeSet& set = state_.scene->cone_sets[cones->set];
            search_tree(entry, space, mask, [&](const WideRef& leaf, RayMask met) HWY_ATTR {
                each_index(tree.bvh, leaf, [&](std::uint32_t primitive) HWY_ATTR {
                    const std::size_t first = std::size_t{2} * primitive;
                    judge_all(entry.object, space, shown,
                              group_cone(set.ends[first], set.ends[first + 1], set.capped),
                              primitive, met);
                    return false;
                });
            });
        } else {
            const SetId set = std::get<SphereSetInstance>(object.shape).set;
            const std::span<const glm::vec4> spheres = state_.scene->sphere_sets[set].spheres;
            search_tree(entry, space, mask, [&](const WideRef& leaf, RayMask met) HWY_ATTR {
                each_index(tree.bvh, leaf, [&](std::uint32_t primitive) HWY_ATTR {
                    judge_all(entry.object, space, shown, group_sphere(space, spheres[primitive]),
                              primitive, met);
                    return false;
                });
            });
        }
    }

    // As its rays see an object, which go from end to start backwards.
    [[nodiscard]] ShownSides shown_to(const GroupSpace& space, const Object& object) const {
        ShownSides shown{shows(object.sides, true) && shows(query_.sides, true),
                         shows(object.sides, false) && shows(query_.sides, false)};
        if (space.course.backwards()) std::swap(shown.front, shown.back);
        return shown;
    }

    // Whose a patch's triangles are, and which sides of them count.
    struct Searched {
        std::uint32_t object = 0;
        ShownSides shown{false, false};
    };

    // searched(patch) says what is searched.
    template <typename SearchedOf>
    HWY_INLINE void search_mesh(const TopEntry& entry, const GroupSpace& space, RayMask mask,
                                const SearchedOf& searched) {
        const TrianglePatches& patches = state_.instances[entry.object].tree->patches;
        search_tree(entry, space, mask, [&](const WideRef& leaf, RayMask met) HWY_ATTR {
            each_patch(patches, leaf, [&](const TrianglePatch& patch) HWY_ATTR {
                const Searched here = searched(patch);
                if (here.shown.any()) judge_patch(here, space, patch, met);
                return false;
            });
        });
    }

    HWY_INLINE void judge_patch(const Searched& searched, const GroupSpace& space,
                                const TrianglePatch& patch, RayMask mask) {
        GroupTriangles triangles;  // NOLINT: not initialised, as it is large
        std::uint32_t left = 0;
        for (std::size_t i = 0; i < patch.triangles; i += kTrianglesAtOnce)
            left |= set_triangles(space, patch, i, triangles) << i;
        if (!space.one_origin && !space.course.backwards() && better_ray_by_ray(patch, mask)) {
            judge_ray_by_ray(searched, space, triangles, patch, mask);
            return;
        }
        left &= (1u << patch.triangles) - 1u;
        for (; left != 0; left &= left - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(left));
            judge_all(searched.object, space, searched.shown, GroupTriangle{triangles, patch, i},
                      patch.primitives()[i], mask);
        }
    }

    void judge_ray_by_ray(const Searched& searched, const GroupSpace& space,
                          const GroupTriangles& triangles, const TrianglePatch& patch,
                          RayMask mask) {
        std::array<std::uint32_t, TrianglePatch::kMostTriangles> places;
        places.fill(ClosestOfGroup::kMostCandidates);
        std::array<RayMask, TrianglePatch::kMostTriangles> open{};
        const Instance& instance = state_.instances[searched.object];
        PatchVerdict verdict;
        each_ray(mask, [&](std::size_t ray) HWY_ATTR {
            judge_patch_of_ray(space.rays, search_.limits, ray, triangles, patch.triangles,
                               searched.shown, verdict);
            std::uint32_t may = verdict.may;
            each_bit(verdict.may, [&](std::size_t i) HWY_ATTR {
                if (crossed(search_, searched.object, patch.primitives()[i], RayMask{1} << ray)) {
                    may &= ~(1u << i);
                }
            });
            if (may == 0) return;
            const std::uint32_t sure = instance.holes ? 0u : verdict.sure & may;
            if constexpr (!std::is_same_v<Group, ClosestOfGroup>) {
                if (sure != 0) {
                    search_.block(RayMask{1} << ray);
                    return;
                }
            }
            each_bit(may & ~sure, [&](std::size_t i) { open[i] |= RayMask{1} << ray; });
            if constexpr (std::is_same_v<Group, ClosestOfGroup>) {
                each_bit(sure, [&](std::size_t i) HWY_ATTR {
                    const GroupTriangle triangle{triangles, patch, i};
                    Taken<GroupTriangle> taken{triangle, instance, searched.object,
                                               patch.primitives()[i], places[i]};
                    take_one(search_, ray, verdict.from[i], verdict.to[i], taken);
                    places[i] = taken.place;
                });
            }
        });
        for (std::size_t i = 0; i < patch.triangles; ++i) {
            if (open[i] == 0) continue;
            settle_open(space, instance, searched.object, GroupTriangle{triangles, patch, i},
                        patch.primitives()[i], open[i]);
        }
    }

    template <typename Leaf>
    HWY_INLINE void search_tree(const TopEntry& entry, const GroupSpace& space, RayMask mask,
                                const Leaf& leaf) {
        walk_group(state_.instances[entry.object].tree->bvh, entry.part, space,
                   search_.limits_in(space), mask, leaf,
                   [&](const WideRef& part, RayMask met) HWY_ATTR {
                       if (is_mesh(entry)) {
                           few_in_mesh({entry.object, part}, met);
                       } else {
                           each_on_its_own({entry.object, part}, met);
                       }
                   });
    }

    [[nodiscard]] bool is_mesh(const TopEntry& entry) const {
        return state_.instances[entry.object].joined() ||
               std::holds_alternative<MeshInstance>(state_.scene->objects[entry.object].shape);
    }

    template <typename Shape>
    HWY_INLINE void judge_all(std::uint32_t object, const GroupSpace& space,
                              const ShownSides& shown, const Shape& shape, std::uint32_t primitive,
                              RayMask mask) {
        Taken<Shape> taken{shape, state_.instances[object], object, primitive};
        each_vector(mask, [&](std::size_t ray, RayMask bits) HWY_ATTR {
            const Verdict verdict = judge_some(space, search_.limits, shape, shown, ray, bits);
            const RayMask may = verdict.may & bits;
            if (may == 0 || crossed(search_, object, primitive, may << ray)) return;
            settle(space, verdict, ray, bits, taken);
        });
    }

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
            auto& later = open_like(shape);
            each_ray(mask, [&](std::size_t i) HWY_ATTR {
                later.add({i, object, primitive});
                if (later.full()) decide_open(later);
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

    OpenSpheres& open_like(const GroupSphere& /*shape*/) { return open_spheres_; }
    OpenCones& open_like(const GroupCone& /*shape*/) { return open_cones_; }

    template <typename Elements>
    HWY_NOINLINE void decide_open(Elements& elements) {
        elements.decide([&](const OpenElement& open, float t)
                            HWY_ATTR { offer(open.ray, open.object, open.primitive, t); },
                        [&](const OpenElement& open) HWY_ATTR {
                            auto one = one_of(search_, open.ray, open.object);
                            trace_primitive(state_, open.object, open.primitive, rays_[open.ray],
                                            query_, one);
                        });
    }

    void decide_last() {
        if (!open_spheres_.empty()) decide_open(open_spheres_);
        if (!open_cones_.empty()) decide_open(open_cones_);
    }

    HWY_INLINE void offer_open(std::uint32_t index, std::uint32_t primitive, std::size_t ray,
                               const TriangleAnswers& answers, std::size_t lane) {
        if (!answers.hits(lane, rays_[ray].t_min, rays_[ray].t_max)) return;
        const bool front = answers.hits_front(lane);
        const Object& object = state_.scene->objects[index];
        if (!shows(object.sides, front) || !shows(query_.sides, front)) return;
        offer(ray, index, primitive, answers.t[lane]);
    }

    // A hit that counts, if none before it does.
    HWY_INLINE void offer(std::size_t ray, std::uint32_t object, std::uint32_t primitive, float t) {
        if (crossed(search_, object, primitive, RayMask{1} << ray)) return;
        if constexpr (!std::is_same_v<Group, ClosestOfGroup>) {
            search_.block(RayMask{1} << ray);
        } else if (t <= search_.limits.t_far[ray]) {
            search_.offer(ray, object, primitive, t);
        }
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    Group& search_;
    // Nothing is left of them at the end.
    OpenSpheres open_spheres_;
    OpenCones open_cones_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
