// Rays of a group with elements of sets of which float bounds can't say whether they hit, as of all
// rays that begin on an element itself: several are decided at once. Included once for each
// instruction set.
#if defined(RAYPICK_OPEN_ELEMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_OPEN_ELEMENTS_INL_H
#undef RAYPICK_OPEN_ELEMENTS_INL_H
#else
#define RAYPICK_OPEN_ELEMENTS_INL_H
#endif

#include "tracer/accel/passage.h"
#include "tracer/accel/simd/decide_cones-inl.h"
#include "tracer/accel/simd/decide_spheres-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/single_ray-inl.h"
#include "tracer/accel/simd/sole_elements-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// Up to kDoublesAtOnce rays with an element each. `Set` is the objects' shape; see SoleElements for
// the others.
template <typename Set, typename Pairs, typename Decided>
class OpenElements {
public:
    OpenElements(const AccelState& state, std::span<const Ray> rays, const RayQuery& query)
        : state_(state), rays_(rays), query_(query) {}

    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] bool full() const { return count_ == kDoublesAtOnce; }

    // Of an object without holes.
    HWY_INLINE void add(const RayAndPrimitive& open) {
        const Scene& scene = *state_.scene;
        const auto* set = std::get_if<Set>(&scene.objects[open.object].shape);
        pairs_.set(count_, object_ray(state_.instances[open.object], rays_[open.ray]),
                   element_of(scene, *set, open.primitive));
        open_[count_++] = open;
    }

    // Calls hits(open, t) for those that hit at a t within the ray's interval, the first one if
    // there are two, and leaves those that this can't decide to scalar(open).
    template <typename Hits, typename Scalar>
    void decide(const Hits& hits, const Scalar& scalar) {
        pairs_.fill_from(count_);
        const Decided decided(pairs_);
        RootsInRange in_range;
        for (std::size_t i = 0; i < count_; ++i) {
            in_range.enters |= within(i, decided.enters_at[i]) << i;
            in_range.leaves |= within(i, decided.leaves_at[i]) << i;
        }
        const std::uint32_t all = (1u << count_) - 1u;
        std::uint32_t open = all & ~decided.ordinary & ~decided.misses;
        if (((in_range.enters | in_range.leaves) & decided.ordinary) != 0) {
            open |= tell_hits(decided, in_range, hits) & decided.ordinary;
        }
        for (; open != 0; open &= open - 1)
            scalar(open_[static_cast<std::size_t>(std::countr_zero(open))]);
        count_ = 0;
    }

private:
    // As masks.
    struct RootsInRange {
        std::uint32_t enters = 0;
        std::uint32_t leaves = 0;
    };

    [[nodiscard]] std::uint32_t within(std::size_t lane, double at) const {
        const Ray& ray = rays_[open_[lane].ray];
        const auto t = static_cast<float>(at);
        return t > ray.t_min && t < ray.t_max ? 1u : 0u;
    }

    // Returns those of which it can't tell.
    template <typename Hits>
    [[nodiscard]] std::uint32_t tell_hits(const Decided& decided, const RootsInRange& in_range,
                                          const Hits& hits) const {
        typename Decided::Hits enters;
        typename Decided::Hits leaves;
        decided.sides_at(0, in_range.enters & decided.ordinary, enters);
        decided.sides_at(~0u, in_range.leaves & decided.ordinary, leaves);
        const std::uint32_t known_enters = decided.enters_by_side & enters.ordinary;
        const std::uint32_t known_leaves = decided.leaves_by_side & leaves.ordinary;
        const std::uint32_t unknown =
            (in_range.enters & ~known_enters) | (in_range.leaves & ~known_leaves);
        const std::uint32_t first = in_range.enters & shown(enters.front);
        const std::uint32_t second = in_range.leaves & shown(leaves.front) & ~first;
        for (std::size_t i = 0; i < count_; ++i) {
            if (((decided.ordinary & ~unknown) >> i & 1u) == 0) continue;
            if ((first >> i & 1u) != 0) hits(open_[i], static_cast<float>(decided.enters_at[i]));
            if ((second >> i & 1u) != 0) hits(open_[i], static_cast<float>(decided.leaves_at[i]));
        }
        return unknown;
    }

    // Of the lanes that hit a front, and those that hit a back, whose object and query show it.
    [[nodiscard]] std::uint32_t shown(std::uint32_t front) const {
        std::uint32_t result = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const bool is_front = (front >> i & 1u) != 0;
            const Sides sides = state_.scene->objects[open_[i].object].sides;
            result |= (shows(sides, is_front) && shows(query_.sides, is_front) ? 1u : 0u) << i;
        }
        return result;
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    std::array<RayAndPrimitive, kDoublesAtOnce> open_;
    std::size_t count_ = 0;
    Pairs pairs_;
};

// Those of a group's rays. Each waits until there are several of its kind.
template <typename Group>
class OpenOfGroup {
public:
    OpenOfGroup(const AccelState& state, std::span<const Ray> rays, const RayQuery& query,
                Group& search)
        : state_(state),
          rays_(rays),
          query_(query),
          search_(search),
          spheres_(state, rays, query),
          cones_(state, rays, query) {}

    // Of an object without holes. `Set` is SphereSet or ConeSet.
    template <typename Set>
    HWY_INLINE void add(const RayAndPrimitive& open) {
        if constexpr (std::is_same_v<Set, SphereSet>) {
            add_to(spheres_, open);
        } else {
            add_to(cones_, open);
        }
    }

    // Called in the end.
    void decide_last() {
        if (!spheres_.empty()) decide(spheres_);
        if (!cones_.empty()) decide(cones_);
    }

private:
    template <typename Elements>
    HWY_INLINE void add_to(Elements& elements, const RayAndPrimitive& open) {
        elements.add(open);
        if (elements.full()) decide(elements);
    }

    template <typename Elements>
    HWY_NOINLINE void decide(Elements& elements) {
        elements.decide(
            [&](const RayAndPrimitive& open, float t)
                HWY_ATTR { offer_hit(search_, open.ray, open.object, open.primitive, t); },
            [&](const RayAndPrimitive& open) HWY_ATTR {
                auto one = one_of(search_, open.ray, open.object);
                trace_primitive(state_, open.object, open.primitive, rays_[open.ray], query_, one);
            });
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    Group& search_;
    OpenElements<SphereSetInstance, SpherePairs, SpheresDecided> spheres_;
    OpenElements<ConeSetInstance, ConePairs, ConesDecided> cones_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
