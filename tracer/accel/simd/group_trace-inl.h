// A group of rays through the objects of a scene. Included once for each instruction set.
#if defined(RAYPICK_GROUP_TRACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_TRACE_INL_H
#undef RAYPICK_GROUP_TRACE_INL_H
#else
#define RAYPICK_GROUP_TRACE_INL_H
#endif

#include "tracer/accel/joined_sets.h"
#include "tracer/accel/simd/decide_rectangles-inl.h"
#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/group_back-inl.h"
#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/accel/simd/group_cones-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/group_settle-inl.h"
#include "tracer/accel/simd/group_spheres-inl.h"
#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/ray_chunk-inl.h"
#include "tracer/accel/simd/ray_run-inl.h"
#include "tracer/accel/simd/rays_apart-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// `Group` is ClosestOfGroup, AnyOfGroup or CrossingsOfGroup.
template <typename Group>
class GroupTrace {
public:
    // The rays are some of the run's.
    GroupTrace(const AccelState& state, std::span<const Ray> rays, const RayQuery& query,
               RayRun& run, Group& search)
        : state_(state),
          rays_(rays),
          query_(query),
          run_(run),
          search_(search),
          settle_(state, rays, query, search) {}

    // The rays of the mask, all usable, in one octant and with t_min >= 0; `world` holds them.
    void run(const GroupRays& group, RayMask mask) {
        for (const std::uint32_t object : state_.unbounded)
            each_on_its_own({object, {}}, mask);
        if (state_.top.empty()) return;
        enter_world(GroupSpace(group, mask, 0.0f, state_.reach), mask);
        settle_.decide_last();
    }

    // The same of a chunk's rays; backwards if they end at `end`, which may be null. Of searches
    // that have limits for both ways.
    void run_towards(const Chunk& chunk, RayMask mask, const glm::vec3* end) {
        GroupBack back;  // NOLINT: not initialised, as it is large
        if (end != nullptr &&
            back.set(chunk.world, chunk.limits, mask, *end, state_.reach, search_.back)) {
            run_back(back, mask);
        } else {
            run(chunk.world, mask);
        }
    }

private:
    // Others that are blocked, too, note what they cross on the way, and must meet it only once.
    static constexpr bool kAny = std::is_same_v<Group, AnyOfGroup>;

    void run_back(const GroupBack& back, RayMask mask) {
        for (const std::uint32_t object : state_.unbounded)
            each_on_its_own({object, {}}, mask);
        if (state_.top.empty()) return;
        enter_world(GroupSpace(back.rays, mask, 0.0f, state_.reach, back.course), mask);
        settle_.decide_last();
    }

    void enter_world(const GroupSpace& world, RayMask mask) {
        if constexpr (kAny) {
            if (search_.blockers != nullptr && !search_.blockers->leaves().empty())
                mask = search_blockers(world, mask);
        }
        walk(
            TreeMemory(state_.top), {kNobody, state_.top.root}, world, mask,
            [&](const WideRef& leaf, RayMask met) HWY_ATTR {
                each_index(state_.top, leaf, [&](std::uint32_t entry) HWY_ATTR {
                    enter(state_.entries[entry], world, met);
                    return false;
                });
            },
            [&](const WideRef& part, RayMask met)
                HWY_ATTR { RaysApart(state_, rays_, query_, search_).run_down(part, met); });
    }

    // walk_group() from where the run's rays begin in the entry, which is nobody's in the top tree.
    template <typename Leaf, typename Few>
    HWY_INLINE void walk(const TreeMemory& tree, const TopEntry& entry, const GroupSpace& space,
                         RayMask mask, const Leaf& leaf, const Few& few) {
        const bool in_world = entry.object == kNobody || state_.instances[entry.object].identity;
        RayRun::Place* const place = in_world ? run_.find(entry) : nullptr;
        const EntryPoints* const points = place != nullptr ? run_.points(space, *place) : nullptr;
        const std::uint32_t opened =
            walk_group(tree, entry.part, points, space, search_.limits_in(space), mask, leaf, few);
        if (in_world && place == nullptr) run_.opened(space, entry, opened);
    }

    // What blocked rays before, as long as rays are left, which it returns. Leaves are kept that do
    // so again or aren't needed.
    HWY_NOINLINE RayMask search_blockers(const GroupSpace& world, RayMask mask) {
        const Blockers before = std::exchange(*search_.blockers, {});
        for (const TopEntry& leaf : before.leaves()) {
            if (mask == 0) {
                search_.blockers->add(leaf);
                continue;
            }
            enter(leaf, world, mask);
            mask &= ~search_.blocked;
        }
        return mask;
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

    // The same for a few rays in what has a tree, or in a part of it.
    void few_in_tree(const TopEntry& entry, RayMask mask) {
        if (RaysApart<Group>::takes_apart(state_.instances[entry.object])) {
            RaysApart(state_, rays_, query_, search_).run_in(entry, mask);
        } else {
            each_on_its_own(entry, mask);
        }
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

    // A joined tree, or a part of it.
    void enter_joined(const TopEntry& entry, const GroupSpace& world, RayMask mask) {
        const Instance& joined = state_.instances[entry.object];
        if (!(joined.tree->reach < kFarthestReach)) {
            each_on_its_own(entry, mask);
            return;
        }
        if (joined.tree->bvh.indices.empty()) {
            search_mesh(entry, world, mask, [&](const TrianglePatch& patch) HWY_ATTR {
                return member(world, joined, patch);
            });
        } else if (world.course.backwards()) {
            enter_joined(entry, GroupSpace(*world.course.forward, mask, 0.0f, state_.reach), mask);
        } else {
            search_joined_sets(entry, world, mask);
        }
    }

    // Whose a joined tree's patch or element is, and which sides of it are searched.
    template <typename Part>
    [[nodiscard]] HWY_INLINE Searched member(const GroupSpace& space, const Instance& joined,
                                             const Part& part) const {
        const std::uint32_t index = joined.members[part.member].object;
        if (index == kNobody) return {};
        const Object& object = state_.scene->objects[index];
        if ((object.mask & query_.mask) == 0) return {};
        return {index, shown_to(space, object)};
    }

    void search_joined_sets(const TopEntry& entry, const GroupSpace& space, RayMask mask) {
        const Instance& joined = state_.instances[entry.object];
        const PrimitiveTree& tree = *joined.tree;
        search_tree(entry, space, mask, [&](const WideRef& at, RayMask met) HWY_ATTR {
            const JoinedLeaf leaf = joined_leaf(tree.bvh, tree.elements, at);
            for (std::size_t i = 0; i < leaf.spheres + leaf.cones; ++i) {
                const JoinedElement& element = leaf.elements[i];
                const Searched here = member(space, joined, element);
                if (!here.shown.any()) continue;
                const glm::vec4* row = leaf.rows + tree.elements.stride * i;
                if (i < leaf.spheres) {
                    judge_all(here.object, space, here.shown, group_sphere(space, *row),
                              element.primitive, met);
                } else {
                    judge_all(here.object, space, here.shown,
                              group_cone(row[0], row[1], tree.elements.capped), element.primitive,
                              met);
                }
            }
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
        const ShownSides sides = shown_sides(object, query_);
        const std::uint32_t shown =
            (sides.front ? decided.front : 0u) | (sides.back ? ~decided.front : 0u);
        each_ray(mask & decided.ordinary & shown, [&](std::size_t lane) HWY_ATTR {
            const std::size_t ray = first + lane;
            const auto t = static_cast<float>(decided.enters_at[lane]);
            if (t > rays_[ray].t_min && t < rays_[ray].t_max) offer_hit(search_, ray, index, 0, t);
        });
    }

    // A mesh or a set with a space of its own.
    void enter_placed(const TopEntry& entry, const GroupSpace& world, RayMask mask, float reach) {
        const Instance& instance = state_.instances[entry.object];
        GroupRays forward{};
        each_ray(mask, [&](std::size_t ray)
                           HWY_ATTR { forward.set(ray, object_ray(instance, rays_[ray])); });
        forward.invert();
        if (std::holds_alternative<SphereSetInstance>(state_.scene->objects[entry.object].shape)) {
            forward.measure_lengths();
        }
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
        ShownSides shown = shown_sides(object, query_);
        if (space.course.backwards()) std::swap(shown.front, shown.back);
        return shown;
    }

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
        // Asked for with several origins only.
        const float t_far = space.one_origin ? 0.0f : farthest(search_.limits_in(space), mask);
        std::uint32_t left = 0;
        for (std::size_t i = 0; i < patch.triangles; i += kTrianglesAtOnce)
            left |= set_triangles(space, t_far, patch, i, triangles) << i;
        left &= (1u << patch.triangles) - 1u;
        if (!space.course.backwards() && better_ray_by_ray(patch, left, mask)) {
            settle_.judge_patch(searched, space, triangles, patch, mask);
            return;
        }
        PatchPairs pairs;
        for (; left != 0; left &= left - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(left));
            const GroupTriangle triangle{triangles, patch, i};
            pairs.add(i, within_edges(space, triangle, searched.shown, mask));
        }
        std::array<std::uint32_t, TrianglePatch::kMostTriangles> places;
        places.fill(ClosestOfGroup::kMostCandidates);
        const Instance& instance = state_.instances[searched.object];
        pairs.each([&](std::size_t i, std::size_t ray, RayMask bits) HWY_ATTR {
            const GroupTriangle triangle{triangles, patch, i};
            Taken<GroupTriangle> taken{triangle, instance, searched.object, patch.primitives()[i],
                                       places[i]};
            judge_vector(space, searched.shown, ray, bits, taken);
            places[i] = taken.place;
        });
    }

    template <typename Leaf>
    HWY_INLINE void search_tree(const TopEntry& entry, const GroupSpace& space, RayMask mask,
                                const Leaf& leaf) {
        walk(
            TreeMemory(*state_.instances[entry.object].tree), entry, space, mask,
            [&](const WideRef& at, RayMask met) HWY_ATTR {
                if constexpr (kAny) search_.leaf = {entry.object, at};
                leaf(at, met);
            },
            [&](const WideRef& part, RayMask met) HWY_ATTR {
                few_in_tree({entry.object, part}, met);
            });
    }

    template <typename Shape>
    HWY_INLINE void judge_all(std::uint32_t object, const GroupSpace& space,
                              const ShownSides& shown, const Shape& shape, std::uint32_t primitive,
                              RayMask mask) {
        Taken<Shape> taken{shape, state_.instances[object], object, primitive};
        each_vector(mask, [&](std::size_t ray, RayMask bits)
                              HWY_ATTR { judge_vector(space, shown, ray, bits, taken); });
    }

    // `bits`: of the vector of rays from `ray` on.
    template <typename Shape>
    HWY_INLINE void judge_vector(const GroupSpace& space, const ShownSides& shown, std::size_t ray,
                                 RayMask bits, Taken<Shape>& taken) {
        const Verdict verdict = judge_some(space, search_.limits, taken.shape, shown, ray, bits);
        const RayMask may = verdict.may & bits;
        if (may == 0 || crossed(search_, taken.object, taken.primitive, may << ray)) return;
        settle_.settle(space, verdict, ray, bits, taken);
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    RayRun& run_;
    Group& search_;
    GroupSettle<Group> settle_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
