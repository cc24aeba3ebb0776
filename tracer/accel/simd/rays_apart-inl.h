// Rays of a group that have little in common, each on its own way through the trees. Included once
// for each instruction set.
#if defined(RAYPICK_RAYS_APART_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAYS_APART_INL_H
#undef RAYPICK_RAYS_APART_INL_H
#else
#define RAYPICK_RAYS_APART_INL_H
#endif

#include "tracer/accel/joined_sets.h"
#include "tracer/accel/leaf_elements.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/open_elements-inl.h"
#include "tracer/accel/simd/ray_cones-inl.h"
#include "tracer/accel/simd/ray_patches-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/tree_memory.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// `Group` is ClosestOfGroup, AnyOfGroup or CrossingsOfGroup. Several rays are on their way at a
// time. All that are at a node take a step, then all that are at a leaf: a loop of one kind of step
// has few branches that can't be foretold, and while one ray waits for memory the others go on.
template <typename Group>
class RaysApart {
public:
    RaysApart(const AccelState& state, std::span<const Ray> rays, const RayQuery& query,
              Group& search)
        : state_(state),
          rays_(rays),
          query_(query),
          search_(search),
          open_(state, rays, query, search) {}

    // The mask's rays, for which what is said of groups holds but that they go one way.
    void run(RayMask mask) {
        for (const std::uint32_t object : state_.unbounded) {
            each_ray(mask, [&](std::size_t ray) HWY_ATTR {
                auto one = one_of(search_, ray, object);
                trace_simple(state_, object, rays_[ray], query_, one);
            });
        }
        if (state_.top.empty()) return;
        if (const TopEntry* only = only_tree()) {
            run_in(*only, mask);
        } else {
            run_down(state_.top.root, mask);
        }
    }

    // The same down a part of the top tree.
    void run_down(const WideRef& part, RayMask mask) {
        follow(mask, [&](Way& way) HWY_ATTR {
            way.stack.push(-std::numeric_limits<float>::infinity(), part.bits);
            go_to_top(way);
        });
    }

    // The same through an object that takes_apart(), or a part of it.
    void run_in(const TopEntry& entry, RayMask mask) {
        follow(mask, [&](Way& way) HWY_ATTR {
            enter_tree(way, entry);
            way.is_last = true;
        });
    }

    // Whether it has a tree that stands in the world's space.
    [[nodiscard]] static bool takes_apart(const Instance& instance) {
        return instance.identity && instance.tree != nullptr;
    }

private:
    static constexpr std::size_t kWays = 16;
    // So many make a loop worth its while.
    static constexpr std::size_t kLeaves = 8;

    // A ray on its way.
    struct Way {
        std::size_t ray;
        WideRef at;
        TreeMemory memory;  // of the tree that it is in
        bool in_top;        // that is the top tree; else an object's:
        const PrimitiveTree* tree;
        const Instance* instance;
        std::uint32_t object;
        bool of_set;  // of spheres or cones; else of triangles

        std::size_t base;  // what waits below is of the top tree; in that it is 0
        bool is_last;      // the tree is all that there is
        bool ended;        // nothing more is wanted of the ray
        float far_before;  // t_far as it was before the leaf
        float t_min;
        float steepest;              // the direction's largest component
        const TrianglePatch* patch;  // of the leaf, and what the bounds say of it
        RayVerdict verdict;
        std::optional<SlabRay> slabs;
        std::optional<RayInSpace> space;  // once it is needed
        WaitingBoxes stack;
    };

    // Those at one kind of place.
    struct Ways {
        std::array<Way*, kWays + 1> way;
        std::size_t count = 0;

        HWY_INLINE Ways take() {
            const Ways all = *this;
            count = 0;
            return all;
        }
    };

    // By where they are.
    struct Places {
        Ways nodes;
        Ways leaves;   // of an object's tree
        Ways objects;  // leaves of the top tree

        // Without a branch, as it can't be foretold which it is.
        HWY_INLINE void put(Way& way) {
            const std::size_t is_leaf = way.at.bits >> 31u;
            const std::size_t in_top = way.in_top;
            nodes.way[nodes.count] = leaves.way[leaves.count] = objects.way[objects.count] = &way;
            nodes.count += 1 - is_leaf;
            leaves.count += is_leaf & (1 - in_top);
            objects.count += is_leaf & in_top;
            way.memory.fetch(way.at);
        }
        [[nodiscard]] bool empty() const { return nodes.count + leaves.count + objects.count == 0; }
        [[nodiscard]] bool few_leaves() const { return leaves.count + objects.count < kLeaves; }
    };

    template <typename Start>
    void follow(RayMask pending, const Start& start) {
        Way ways[kWays];  // NOLINT: large, and set when they begin
        Places places;
        const auto go_on = [&](Way& way) HWY_ATTR {
            if (goes_on(way, pending, start)) places.put(way);
        };
        for (std::size_t i = 0; i < kWays && pending != 0; ++i) {
            begin(ways[i], pending, start);
            go_on(ways[i]);
        }
        while (!places.empty()) {
            while (places.nodes.count > 0 && places.few_leaves()) {
                const std::size_t count = std::exchange(places.nodes.count, 0);
                for (std::size_t i = 0; i < count; ++i) {
                    Way& way = *places.nodes.way[i];
                    way.slabs->push_met(way.memory.node(way.at), way.t_min,
                                        search_.limits.t_far[way.ray], way.stack);
                    go_on(way);
                }
            }
            const Ways objects = places.objects.take();
            const Ways leaves = places.leaves.take();
            search_leaves(leaves);
            for (std::size_t i = 0; i < leaves.count; ++i)
                go_on(*leaves.way[i]);
            for (std::size_t i = 0; i < objects.count; ++i) {
                enter_objects(*objects.way[i]);
                go_on(*objects.way[i]);
            }
        }
        open_.decide_last();
    }

    // With the lowest ray of the mask.
    template <typename Start>
    HWY_INLINE void begin(Way& way, RayMask& pending, const Start& start) {
        way.ray = static_cast<std::size_t>(std::countr_zero(pending));
        pending &= pending - 1;
        const Ray& from = rays_[way.ray];
        way.t_min = from.t_min;
        way.steepest = largest_of(from.direction);
        way.slabs.emplace(from, kDoubleSlop * std::max(largest_of(from.origin), state_.reach));
        way.space.reset();
        way.stack.count = 0;
        way.is_last = false;
        way.ended = false;
        start(way);
    }

    // Takes what waits on top of the stack, if need be of another ray; false if there is none.
    template <typename Start>
    HWY_INLINE bool goes_on(Way& way, RayMask& pending, const Start& start) {
        if (way.stack.count <= way.base && !goes_on_elsewhere(way, pending, start)) return false;
        way.at = {way.stack.ref[--way.stack.count]};
        return true;
    }

    // The same of a way that has no more of its tree: in the top tree, or with another ray.
    template <typename Start>
    HWY_NOINLINE bool goes_on_elsewhere(Way& way, RayMask& pending, const Start& start) {
        if (!way.in_top && !way.is_last) {
            go_to_top(way);
            way.stack.drop_beyond(search_.limits.t_far[way.ray], 0);
        }
        while (way.stack.count <= way.base) {
            if (pending == 0) return false;
            begin(way, pending, start);
        }
        return true;
    }

    void go_to_top(Way& way) const {
        way.in_top = true;
        way.base = 0;
        way.memory = TreeMemory(state_.top);
    }

    HWY_INLINE void enter_tree(Way& way, const TopEntry& entry) const {
        way.in_top = false;
        way.object = entry.object;
        way.instance = &state_.instances[entry.object];
        way.tree = way.instance->tree;
        way.memory = TreeMemory(*way.tree);
        way.of_set = !way.tree->bvh.indices.empty();
        way.base = way.stack.count;
        way.stack.push(-std::numeric_limits<float>::infinity(), entry.part.bits);
    }

    // At a leaf of the top tree.
    HWY_NOINLINE void enter_objects(Way& way) {
        const std::uint32_t index = state_.top.indices[way.at.index()];
        const TopEntry& first = state_.entries[index & ~WideBvh::kLast];
        if ((index & WideBvh::kLast) != 0 && goes_into(first)) {
            enter_tree(way, first);
            return;
        }
        each_index(state_.top, way.at, [&](std::uint32_t number) HWY_ATTR {
            const TopEntry& entry = state_.entries[number];
            auto one = one_of(search_, way.ray, entry.object);
            return trace_entry(state_, entry, rays_[way.ray], space_of(way), query_, one);
        });
        way.stack.drop_beyond(search_.limits.t_far[way.ray], 0);
    }

    [[nodiscard]] const TopEntry* only_tree() const {
        if (!state_.top.root.is_leaf()) return nullptr;
        const std::uint32_t index = state_.top.indices[state_.top.root.index()];
        const TopEntry& entry = state_.entries[index & ~WideBvh::kLast];
        const bool is_only = (index & WideBvh::kLast) != 0;
        return is_only && goes_into(entry) ? &entry : nullptr;
    }

    [[nodiscard]] bool goes_into(const TopEntry& entry) const {
        const Instance& instance = state_.instances[entry.object];
        if (instance.joined()) return true;
        return takes_apart(instance) &&
               (state_.scene->objects[entry.object].mask & query_.mask) != 0;
    }

    RayInSpace& space_of(Way& way) const {
        if (!way.space) way.space.emplace(rays_[way.ray], state_.reach);
        return *way.space;
    }

    // First what all of them do, then what few do and can't be foretold: so one way's work begins
    // before the other's ends.
    HWY_INLINE void search_leaves(const Ways& some) {
        Ways met;
        Ways with_cones;
        for (std::size_t i = 0; i < some.count; ++i) {
            Way& way = *some.way[i];
            way.far_before = search_.limits.t_far[way.ray];
            if (!way.of_set) {
                judge_patch(way);
                met.way[met.count] = &way;
                met.count += way.verdict.may != 0 ? 1u : 0u;
            } else if (search_set(way)) {
                with_cones.way[with_cones.count++] = &way;
            } else {
                leave_leaf(way);
            }
        }
        for (std::size_t i = 0; i < met.count; ++i) {
            settle_patch(*met.way[i]);
            leave_leaf(*met.way[i]);
        }
        if (with_cones.count == 0) return;
        judge_cones();
        for (std::size_t i = 0; i < with_cones.count; ++i)
            leave_leaf(*with_cones.way[i]);
    }

    // The leaf's next patch, if there is one, waits where the leaf did: never too far away to be
    // looked at.
    HWY_INLINE void judge_patch(Way& way) {
        const TrianglePatch& patch = way.tree->patches.at(way.at.index());
        way.patch = &patch;
        judge(way, patch, {}, way.verdict);
        const auto next = static_cast<std::uint32_t>(way.at.index() + patch.size());
        way.stack.push(-std::numeric_limits<float>::infinity(), WideRef::leaf(next).bits);
        way.stack.count -= patch.last;
    }

    // True: some of its cones wait to be judged.
    HWY_INLINE bool search_set(Way& way) {
        if (way.instance->joined()) return search_joined(way);
        const Shape& shape = state_.scene->objects[way.object].shape;
        const std::span<const std::uint32_t> leaf = indices_of(way.tree->bvh, way.at);
        if (const auto* spheres = std::get_if<SphereSetInstance>(&shape)) {
            search_spheres(way, state_.scene->sphere_sets[spheres->set], leaf);
            return false;
        }
        const ConeSet& cones = state_.scene->cone_sets[std::get<ConeSetInstance>(shape).set];
        for (const std::uint32_t index : leaf) {
            const std::uint32_t primitive = index & ~WideBvh::kLast;
            add_cone(way, way.object, primitive, &cones.ends[kConeRows * primitive], cones.capped);
        }
        return true;
    }

    HWY_INLINE void leave_leaf(Way& way) {
        if (way.ended) {
            way.stack.count = way.base = 0;
            way.is_last = true;
            return;
        }
        const float far = search_.limits.t_far[way.ray];
        if (far < way.far_before) way.stack.drop_beyond(far, way.base);
    }

    // Of a leaf of a set.
    HWY_INLINE void search_spheres(Way& way, const SphereSet& set,
                                   std::span<const std::uint32_t> leaf) {
        const SphereFilter filter(rays_[way.ray]);
        for (std::size_t i = 0; i < leaf.size(); i += SphereFilter::kAtOnce) {
            const auto some = leaf.subspan(i, std::min(SphereFilter::kAtOnce, leaf.size() - i));
            RayVerdict verdict;
            filter.judge(elements_of(set, some), search_.limits.t_far[way.ray], {}, verdict);
            each_bit(verdict.may, [&](std::size_t k) HWY_ATTR {
                settle_element<SphereSet>(way, way.object, some[k] & ~WideBvh::kLast, verdict, k);
            });
        }
    }

    // Of a leaf of joined sets. True: some of its cones wait to be judged.
    HWY_INLINE bool search_joined(Way& way) {
        const JoinedElements& joined = way.tree->elements;
        const JoinedLeaf leaf = joined_leaf(way.tree->bvh, joined, way.at);
        const auto object = [&](std::size_t i) HWY_ATTR {
            return way.instance->members[leaf.elements[i].member].object;
        };
        for (std::size_t i = 0; i < leaf.spheres; i += SphereFilter::kAtOnce) {
            const LeafElements some{leaf.rows + joined.stride * i, joined.stride,
                                    std::min(SphereFilter::kAtOnce, leaf.spheres - i)};
            RayVerdict verdict;
            SphereFilter(rays_[way.ray]).judge(some, search_.limits.t_far[way.ray], {}, verdict);
            each_bit(verdict.may, [&](std::size_t k) HWY_ATTR {
                settle_element<SphereSet>(way, object(i + k), leaf.elements[i + k].primitive,
                                          verdict, k);
            });
        }
        for (std::size_t i = leaf.spheres; i < leaf.spheres + leaf.cones; ++i) {
            add_cone(way, object(i), leaf.elements[i].primitive, leaf.rows + joined.stride * i,
                     joined.capped);
        }
        return leaf.cones != 0;
    }

    HWY_INLINE void add_cone(Way& way, std::uint32_t object, std::uint32_t primitive,
                             const glm::vec4* ends, bool capped) {
        if (cones_.full() || !cones_.takes(capped)) judge_cones();
        waiting_[cones_.count()] = {&way, object, primitive};
        cones_.add(rays_[way.ray], way.steepest, search_.limits.t_far[way.ray], ends, capped);
    }

    HWY_NOINLINE void judge_cones() {
        RayVerdict verdict;
        cones_.judge(verdict);
        cones_.clear();
        each_bit(verdict.may, [&](std::size_t i) HWY_ATTR {
            const WaitingCone& cone = waiting_[i];
            settle_element<ConeSet>(*cone.way, cone.object, cone.primitive, verdict, i);
        });
    }

    // What number i of a verdict, which is of both sides, says of an object's element.
    template <typename Set>
    HWY_NOINLINE void settle_element(Way& way, std::uint32_t index, std::uint32_t primitive,
                                     const RayVerdict& verdict, std::size_t i) {
        if (index == kNobody) return;
        const Object& object = state_.scene->objects[index];
        if ((object.mask & query_.mask) == 0) return;
        const ShownSides shown = shown_sides(object, query_);
        if (!shown.any()) return;
        if (crossed(search_, index, primitive, RayMask{1} << way.ray)) return;
        if (state_.instances[index].holes) {
            auto one = one_of(search_, way.ray, index);
            way.ended |= trace_primitive(state_, index, primitive, rays_[way.ray], query_, one);
        } else if (!shown.front || !shown.back || (verdict.sure >> i & 1u) == 0) {
            open_.template add<Set>({static_cast<std::uint32_t>(way.ray), index, primitive});
        } else if constexpr (std::is_same_v<Group, ClosestOfGroup>) {
            take_alone(search_, way.ray, verdict.from[i], verdict.to[i], index, primitive);
        } else {
            search_.block(RayMask{1} << way.ray);
            way.ended = true;
        }
    }

    // What it may hit of the patch. Most patches are missed: whose it is comes only now.
    HWY_INLINE void settle_patch(Way& way) {
        const TrianglePatch& patch = *way.patch;
        const std::uint32_t index =
            way.instance->joined() ? way.instance->members[patch.member].object : way.object;
        if (index == kNobody) return;
        const Object& object = state_.scene->objects[index];
        if ((object.mask & query_.mask) == 0) return;
        const ShownSides shown = shown_sides(object, query_);
        if (!shown.any()) return;
        if (!shown.front || !shown.back) judge(way, patch, shown, way.verdict);
        way.ended = settle(way, index, patch, way.verdict);
    }

    HWY_INLINE void judge(const Way& way, const TrianglePatch& patch, const ShownSides& shown,
                          RayVerdict& verdict) const {
        judge_patch_alone(rays_[way.ray], way.steepest, search_.limits.t_far[way.ray], patch, shown,
                          verdict);
    }

    // True: the ray has ended.
    HWY_INLINE bool settle(Way& way, std::uint32_t object, const TrianglePatch& patch,
                           const RayVerdict& verdict) {
        const Instance& instance = state_.instances[object];
        const std::uint32_t may = not_crossed(search_, object, patch, verdict.may, way.ray);
        const std::uint32_t sure = instance.holes ? 0u : verdict.sure & may;
        if constexpr (std::is_same_v<Group, ClosestOfGroup>) {
            each_bit(sure, [&](std::size_t i) HWY_ATTR {
                Candidate* kept = take_alone(search_, way.ray, verdict.from[i], verdict.to[i],
                                             object, patch.primitives()[i]);
                if (kept != nullptr) keep_corners(patch, i, instance, *kept);
            });
        } else if (sure != 0) {
            search_.block(RayMask{1} << way.ray);
            return true;
        }
        return (may & ~sure) != 0 && decide(way, object, patch, may & ~sure);
    }

    // The triangles that the bounds leave open. True: the ray has ended.
    HWY_NOINLINE bool decide(Way& way, std::uint32_t index, const TrianglePatch& patch,
                             std::uint32_t some) {
        const Ray& ray = rays_[way.ray];
        const Instance& instance = state_.instances[index];
        const Passage passage{*state_.scene, state_.scene->objects[index], instance, ray,
                              query_,        object_ray(instance, ray)};
        auto one = one_of(search_, way.ray, index);
        using One = decltype(one);
        return ShapeTrace<One>{passage, &space_of(way), {}, one}.triangles(patch, some);
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    Group& search_;
    OpenOfGroup<Group> open_;
    RayCones cones_;  // to be judged
    struct WaitingCone {
        Way* way;
        std::uint32_t object;  // index
        std::uint32_t primitive;
    };
    std::array<WaitingCone, RayCones::kAtOnce> waiting_;  // whose they are
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
