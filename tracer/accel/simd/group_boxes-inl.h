// Boxes against a group of rays: all children at once against the whole group by interval
// arithmetic, then those that are left against each ray. Included once for each instruction set.
//
// Source: Reshetov, Soupikov, Hurley, "Multi-Level Ray Tracing Algorithm", 2005; Wald, Boulos,
// Shirley, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume Hierarchies", 2007.
#if defined(RAYPICK_GROUP_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_BOXES_INL_H
#undef RAYPICK_GROUP_BOXES_INL_H
#else
#define RAYPICK_GROUP_BOXES_INL_H
#endif

#include "tracer/accel/simd/ray_group-inl.h"
#include "tracer/accel/tree_memory.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No more rays than these are followed one by one.
inline constexpr int kFewRays = 4;

inline constexpr float kGrowGroup = 1.0f + 8.0f * 5.9604645e-8f;
inline constexpr float kShrinkGroup = 1.0f - 8.0f * 5.9604645e-8f;

// How a node's boxes lie along the group's rays, by child.
struct BoxIntervals {
    HWY_ALIGN std::array<float, kWidth> near;
    HWY_ALIGN std::array<float, kWidth> far;
    std::uint32_t by_all = 0;  // children that all lines meet, wherever on them, as a mask
};

// Where the group's rays enter and leave, along one axis, what lies between each lane's two planes.
template <class V>
struct SlabMet {
    V near_least, near_most;
    V far_least, far_most;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SlabMet<V> meet_slabs(D d, const GroupBounds& space, std::size_t axis,
                                 const V& first_plane, const V& second_plane) {
    const auto low = hn::Set(d, space.inverse_low[axis]);
    const auto high = hn::Set(d, space.inverse_high[axis]);
    const auto to_first = hn::Sub(first_plane, hn::Set(d, space.near_origin[axis]));
    const auto to_second = hn::Sub(second_plane, hn::Set(d, space.far_origin[axis]));
    const auto near_low = hn::Mul(to_first, low);
    const auto near_high = hn::Mul(to_first, high);
    const auto far_low = hn::Mul(to_second, low);
    const auto far_high = hn::Mul(to_second, high);
    return {hn::Min(near_low, near_high), hn::Max(near_low, near_high), hn::Min(far_low, far_high),
            hn::Max(far_low, far_high)};
}

HWY_INLINE void meet_group(const GroupBounds& space, const WideNode& node, float t_min, float t_far,
                           BoxIntervals& boxes) {
    const Boxes d;
    for (std::size_t i = 0; i < kWidth; i += kBoxesAtOnce) {
        auto near = hn::Set(d, t_min);
        auto far = hn::Set(d, t_far);
        auto last_near = near;
        auto first_far = hn::Set(d, std::numeric_limits<float>::infinity());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto met =
                meet_slabs(d, space, axis, hn::Load(d, node.planes[space.first[axis]].data() + i),
                           hn::Load(d, node.planes[space.second[axis]].data() + i));
            near = hn::Max(near, met.near_least);
            far = hn::Min(far, met.far_most);
            if (space.one_origin) {
                last_near = hn::Max(last_near, met.near_most);
                first_far = hn::Min(first_far, met.far_least);
            }
        }
        near = hn::Mul(near, hn::Set(d, kShrinkGroup));
        far = hn::Mul(far, hn::Set(d, kGrowGroup));
        if (space.one_origin) boxes.by_all |= box_bits(hn::Le(last_near, first_far)) << i;
        hn::Store(near, d, boxes.near.data() + i);
        hn::Store(far, d, boxes.far.data() + i);
    }
}

// Places in a tree that lie in the way of many groups, so that each can begin there and not at the
// root: nodes that are of no tree, whose children are these places.
//
// Source: Reshetov et al. 2005 (see above), which has a single one.
struct EntryPoints {
    static constexpr std::size_t kMost = 32;
    static constexpr std::size_t kMostNodes = kMost / kWidth;

    // From near to far, and their children from far to near.
    std::array<WideNode, kMostNodes> nodes;
    std::size_t count;  // of them

    // Of what lies below `start` and rays within the bounds may meet from t_least on. Nodes are
    // opened level by level, near ones first, as long as there is room.
    EntryPoints(const TreeMemory& tree, const WideRef& start, const GroupBounds& bounds,
                float t_least) {
        std::array<Place, kMost> places[2];  // NOLINT: not initialised
        std::size_t found = open(tree.node(start), bounds, t_least, places[0].data());
        std::size_t now = 0;
        for (bool opened = true; opened; now = 1 - now) {
            opened = false;
            const std::size_t before = std::exchange(found, 0);
            for (std::size_t i = 0; i < before; ++i) {
                const Place& place = places[now][i];
                Place* const to = places[1 - now].data() + found;
                const WideRef ref = place.node->ref(place.child);
                if (ref.is_leaf() || found + kWidth + (before - i - 1) > kMost) {
                    *to = place;
                    ++found;
                } else {
                    found += open(tree.node(ref), bounds, t_least, to);
                    opened = true;
                }
            }
        }
        gather(places[now].data(), found);
    }

private:
    struct Place {
        const WideNode* node;
        std::uint32_t child;
    };

    // The children that are met, near ones first. Writes up to kWidth, whatever it returns.
    static std::size_t open(const WideNode& node, const GroupBounds& bounds, float t_least,
                            Place* to) {
        BoxIntervals boxes;  // NOLINT: not initialised, as all are set
        meet_group(bounds, node, t_least, std::numeric_limits<float>::infinity(), boxes);
        const std::uint32_t order = node.far_to_near(bounds.octant);
        std::size_t count = 0;
        for (std::uint32_t i = kWidth; i-- > 0;) {
            const std::uint32_t child = order >> 3 * i & 7u;
            to[count] = {&node, child};
            count += boxes.near[child] <= boxes.far[child] ? 1u : 0u;
        }
        return count;
    }

    void gather(const Place* places, std::size_t found) {
        constexpr std::uint32_t kInOrder = 076543210;
        count = (found + kWidth - 1) / kWidth;
        for (std::size_t n = 0; n < count; ++n) {
            WideNode& node = nodes[n];
            for (std::size_t octant = 0; octant < 8; ++octant)
                std::memcpy(node.order.data() + 3 * octant, &kInOrder, sizeof kInOrder);
            for (std::size_t i = 0; i < kWidth; ++i) {
                const std::size_t k = kWidth * n + kWidth - 1 - i;
                const bool there = k < found;
                for (std::size_t plane = 0; plane < 6; ++plane) {
                    node.planes[plane][i] =
                        there ? places[k].node->planes[plane][places[k].child]
                              : std::copysign(std::numeric_limits<float>::infinity(),
                                              plane < 3 ? 1.0f : -1.0f);
                }
                node.child[i] = there ? places[k].node->child[places[k].child] : WideRef::kNothing;
            }
        }
    }
};

// Of the rays in `mask` those that may meet child i before their t_far.
HWY_INLINE RayMask meet_rays(const GroupSpace& space, const GroupLimits& limits,
                             const WideNode& node, std::size_t i, RayMask mask) {
    const Rays d;
    float first[3];
    float second[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float slop = space.first[axis] >= 3 ? -space.slop[axis] : space.slop[axis];
        first[axis] = node.planes[space.first[axis]][i] - slop;
        second[axis] = node.planes[space.second[axis]][i] + slop;
        if (space.one_origin) {
            first[axis] -= space.origin_low[axis];
            second[axis] -= space.origin_low[axis];
        }
    }
    RayMask met = 0;
    every_vector(mask, [&](std::size_t ray, RayMask bits) HWY_ATTR {
        RayFloats near[3];
        RayFloats far[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            auto to_first = hn::Set(d, first[axis]);
            auto to_second = hn::Set(d, second[axis]);
            if (!space.one_origin) {
                const auto origin = hn::Load(d, space.rays.origin[axis].data() + ray);
                to_first = hn::Sub(to_first, origin);
                to_second = hn::Sub(to_second, origin);
            }
            const auto inverse = hn::Load(d, space.rays.inverse[axis].data() + ray);
            near[axis] = hn::Mul(to_first, inverse);
            far[axis] = hn::Mul(to_second, inverse);
        }
        const auto enter =
            hn::Max(hn::Load(d, limits.t_min.data() + ray),
                    hn::Mul(hn::Max(hn::Max(near[0], near[1]), near[2]), hn::Set(d, kShrinkGroup)));
        const auto leave =
            hn::Min(hn::Load(d, limits.t_far.data() + ray),
                    hn::Mul(hn::Min(hn::Min(far[0], far[1]), far[2]), hn::Set(d, kGrowGroup)));
        met |= (ray_bits(hn::Le(enter, leave)) & bits) << ray;
    });
    return met;
}

// The largest t_far of the rays in `mask`; -infinity if none is to be followed further.
HWY_INLINE float farthest(const GroupLimits& limits, RayMask mask) {
    const Rays d;
    auto far = hn::Set(d, -std::numeric_limits<float>::infinity());
    every_vector(mask, [&](std::size_t ray, RayMask bits) HWY_ATTR {
        const auto its_far = hn::Load(d, limits.t_far.data() + ray);
        far = hn::Max(far, hn::IfThenElse(ray_mask(bits), its_far, far));
    });
    return hn::GetLane(hn::MaxOfLanes(d, far));
}

// Children that some ray of a group may meet, in its way through a tree. Which rays do is asked
// when their turn comes: most rays may end before. Not initialised, as it is large.
struct WaitingChildren {
    // Of the tree and its entry points.
    static constexpr std::size_t kMostParents = Bvh::kMaxDepth + 1 + EntryPoints::kMostNodes;
    static constexpr std::size_t kMost = WideBvh::kMostWaiting + EntryPoints::kMost;

    // Where children wait.
    struct Parent {
        const WideNode* node;
        RayMask rays;  // that met it, some of which may have ended
        float far;     // none of them went further, when so many leaves had been searched:
        std::uint32_t leaves;
    };
    struct Child {
        WideRef ref;
        float enter;  // its box, at the earliest
        Parent& parent;
        std::size_t number;  // of the parent's children
        bool by_all;         // all of the parent's rays meet it
    };

    std::size_t count;
    std::uint32_t ref[kMost];
    float enter[kMost];
    std::uint32_t place[kMost];  // number, by_all << 3, the parent's number << 4
    Parent parent[kMostParents];

    // Far ones first.
    HWY_INLINE void push(const GroupSpace& space, const Parent& of) {
        const std::uint32_t depth = count == 0 ? 0 : (place[count - 1] >> 4u) + 1;
        parent[depth] = of;
        const WideNode& node = *of.node;
        BoxIntervals boxes;  // NOLINT: not initialised, as all are set
        meet_group(space, node, space.t_least(), of.far, boxes);
#if HWY_TARGET <= HWY_AVX2
        const Boxes d;
        const FarToNear::Numbers du;
        const FarToNear order(node, space.octant);
        const auto near = order.of(hn::Load(d, boxes.near.data()));
        const Packing<Boxes> met(hn::Le(near, order.of(hn::Load(d, boxes.far.data()))));
        const auto number = order.numbers();
        const auto by_all = hn::And(hn::Shr(hn::Set(du, boxes.by_all), number), hn::Set(du, 1u));
        const auto at = hn::Or(hn::Or(number, hn::ShiftLeft<3>(by_all)), hn::Set(du, depth << 4u));
        hn::StoreU(met.of(order.of(hn::Load(du, node.child.data()))), du, ref + count);
        hn::StoreU(met.of(near), d, enter + count);
        hn::StoreU(met.of(at), du, place + count);
        count += met.count();
#else
        std::uint32_t order = node.far_to_near(space.octant);
        for (std::uint32_t i = 0; i < kWidth; ++i, order >>= 3) {
            const std::uint32_t child = order & 7u;
            ref[count] = node.child[child];
            enter[count] = boxes.near[child];
            place[count] = child | (boxes.by_all >> child & 1u) << 3u | depth << 4u;
            count += boxes.near[child] <= boxes.far[child] ? 1u : 0u;
        }
#endif
    }

    // Those whose turn comes first. So many without a branch, as it can't be foretold how many
    // wait.
    HWY_INLINE void fetch_next(const TreeMemory& tree) const {
        for (std::size_t i = 1; i <= 3; ++i)
            tree.fetch({ref[count > i ? count - i : 0]});
    }

    HWY_INLINE Child pop() {
        const std::uint32_t at = place[--count];
        return {{ref[count]}, enter[count], parent[at >> 4u], at & 7u, (at & 8u) != 0};
    }
};

// Calls leaf(ref, mask) for leaves that the rays may meet, near ones first, and few(ref, mask) for
// what is left of the tree below a place where no more than kFewRays go on together. Begins at
// `start`, or at the points if they aren't null. Returns how many of the tree's nodes were opened.
template <typename Leaf, typename Few>
std::uint32_t walk_group(const TreeMemory& tree, const WideRef& start, const EntryPoints* points,
                         const GroupSpace& space, const GroupLimits& limits, RayMask rays,
                         const Leaf& leaf, const Few& few) {
    WaitingChildren waiting;  // NOLINT: not initialised, for it is large
    waiting.count = 0;
    std::uint32_t opened = 0;  // nodes
    std::uint32_t leaves = 0;  // so many were searched, and perhaps made the rays shorter
    WideRef at = start;
    float far = farthest(limits, rays);
    if (!(space.t_least() <= far)) return opened;
    for (;;) {
        if (points != nullptr) {
            for (std::size_t i = points->count; i-- > 0;)
                waiting.push(space, {&points->nodes[i], rays, far, leaves});
            points = nullptr;
        } else if (at.is_leaf()) {
            leaf(at, rays);
            ++leaves;
        } else if (std::popcount(rays) <= kFewRays) {
            few(at, rays);
            ++leaves;
        } else {
            waiting.push(space, {&tree.node(at), rays, far, leaves});
            waiting.fetch_next(tree);
            ++opened;
        }
        do {
            if (waiting.count == 0) return opened;
            const WaitingChildren::Child next = waiting.pop();
            WaitingChildren::Parent& parent = next.parent;
            if (parent.leaves != leaves) {
                parent.far = farthest(limits, parent.rays);
                parent.leaves = leaves;
            }
            far = parent.far;
            rays = 0;
            if (!(next.enter <= far)) continue;
            at = next.ref;
            rays = next.by_all ? parent.rays
                               : meet_rays(space, limits, *parent.node, next.number, parent.rays);
        } while (rays == 0);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
