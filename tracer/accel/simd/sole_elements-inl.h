// Cones and spheres of sets, and rectangles, that are a ray's only candidate, several at once.
// Included once for each instruction set.
#if defined(RAYPICK_SOLE_ELEMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_SOLE_ELEMENTS_INL_H
#undef RAYPICK_SOLE_ELEMENTS_INL_H
#else
#define RAYPICK_SOLE_ELEMENTS_INL_H
#endif

#include "tracer/accel/passage.h"
#include "tracer/accel/simd/decide_cones-inl.h"
#include "tracer/accel/simd/decide_rectangles-inl.h"
#include "tracer/accel/simd/decide_spheres-inl.h"
#include "tracer/accel/simd/group_search-inl.h"
#include "tracer/accel/simd/ray_verdict-inl.h"

#include <array>
#include <bit>
#include <span>
#include <variant>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline Cone element_of(const Scene& scene, const ConeSetInstance& instance, std::uint32_t number) {
    return cone_of(scene.cone_sets[instance.set], number);
}
inline Sphere element_of(const Scene& scene, const SphereSetInstance& instance,
                         std::uint32_t number) {
    return sphere_of(scene.sphere_sets[instance.set], number);
}

inline const Rectangle& element_of(const Scene& /*scene*/, const Rectangle& rectangle,
                                   std::uint32_t /*number*/) {
    return rectangle;
}

// Up to kDoublesAtOnce rays whose only candidate is an element of a set, or a rectangle. `Set` is
// the shape's type.
template <typename Set, typename Pairs, typename Decided>
class SoleElements {
public:
    SoleElements(const AccelState& state, const ClosestOfGroup& search, std::span<const Ray> rays,
                 const RayQuery& query)
        : state_(state), search_(search), rays_(rays), query_(query) {}

    [[nodiscard]] bool full() const { return count_ == kDoublesAtOnce; }

    // False if this isn't for it.
    HWY_INLINE bool add(std::size_t ray) {
        const Candidate& candidate = search_.candidate_of(ray);
        const Instance& instance = state_.instances[candidate.object];
        const Object& object = state_.scene->objects[candidate.object];
        const auto* set = std::get_if<Set>(&object.shape);
        if (set == nullptr || instance.holes) return false;
        pairs_.set(count_, object_ray(instance, rays_[ray]),
                   element_of(*state_.scene, *set, candidate.primitive));
        lanes_[count_++] = ray;
        mask_ |= RayMask{1} << ray;
        return true;
    }

    // Decides those that are left, if that is worth it.
    RayMask rest(std::span<Hit> hits) { return count_ > 1 ? decide(hits) : mask_; }

    // Those that this can't decide stay in the mask that it returns.
    RayMask decide(std::span<Hit> hits) {
        pairs_.fill_from(count_);
        const RayMask open = decide(Decided(pairs_), (1u << count_) - 1u, hits);
        count_ = 0;
        mask_ = 0;
        return open;
    }

    // The same of rays where they are: those of the mask, counted from `first` on, with one and the
    // same element in world space. While none were added.
    RayMask decide_in_place(const GroupRays& world, std::size_t first, std::uint32_t mask,
                            const Set& element, std::span<Hit> hits) {
        each_bit(mask, [&](std::size_t lane) HWY_ATTR { lanes_[lane] = first + lane; });
        return decide(Decided(world, first, element), mask, hits);
    }

private:
    RayMask decide(const Decided& decided, std::uint32_t mask, std::span<Hit> hits) {
        std::uint32_t left = 0;
        std::uint32_t leaving = 0;
        each_bit(mask, [&](std::size_t i) HWY_ATTR {
            const std::uint32_t bit = 1u << i;
            const bool enters = in_range(i, decided.enters_at[i]);
            const bool leaves = !enters && in_range(i, decided.leaves_at[i]);
            const std::uint32_t by_side = enters ? decided.enters_by_side : decided.leaves_by_side;
            if (leaves) leaving |= bit;
            if (!(enters || leaves) || (decided.ordinary & by_side & bit) == 0) left |= bit;
        });
        typename Decided::Hits found;
        decided.sides_at(leaving, mask & ~left, found);
        if (query_.uv) decided.uv_at(leaving, found);
        RayMask open = 0;
        each_bit(mask, [&](std::size_t i) HWY_ATTR {
            const bool leaves = ((leaving >> i) & 1) != 0;
            const bool fine = (((found.ordinary & ~left) >> i) & 1) != 0 &&
                              store(i, leaves ? decided.leaves_at[i] : decided.enters_at[i], found,
                                    hits[lanes_[i]]);
            if (!fine) open |= RayMask{1} << lanes_[i];
        });
        return open;
    }

    [[nodiscard]] bool in_range(std::size_t lane, double at) const {
        const auto t = static_cast<float>(at);
        return t > rays_[lanes_[lane]].t_min && t < rays_[lanes_[lane]].t_max;
    }

    bool store(std::size_t lane, double t, const typename Decided::Hits& found, Hit& hit) const {
        const std::size_t ray = lanes_[lane];
        const Candidate& candidate = search_.candidate_of(ray);
        const Object& object = state_.scene->objects[candidate.object];
        const bool front = ((found.front >> lane) & 1) != 0;
        if (!shows(object.sides, front) || !shows(query_.sides, front)) return false;
        hit = {object.id, candidate.primitive, static_cast<float>(t),
               query_.uv ? glm::vec2(found.uv(lane)) : glm::vec2(0.0f), front};
        return true;
    }

    const AccelState& state_;
    const ClosestOfGroup& search_;
    std::span<const Ray> rays_;
    const RayQuery& query_;
    Pairs pairs_;
    std::array<std::size_t, kDoublesAtOnce> lanes_{};
    std::size_t count_ = 0;
    RayMask mask_ = 0;
};

using SoleCones = SoleElements<ConeSetInstance, ConePairs, ConesDecided>;
using SoleSpheres = SoleElements<SphereSetInstance, SpherePairs, SpheresDecided>;
using SoleRectangles = SoleElements<Rectangle, RectanglePairs, RectanglesDecided>;

// Of rays side by side that look at one rectangle, as at a floor: takes them out of the mask, and
// returns those that this can't decide.
inline RayMask decide_rectangles_in_place(const AccelState& state, const ClosestOfGroup& search,
                                          RayMask& mask, const GroupRays& world,
                                          SoleRectangles& rectangles, std::span<Hit> hits) {
    constexpr RayMask kSome = (RayMask{1} << kDoublesAtOnce) - 1;
    RayMask left = 0;
    for (std::size_t first = 0; first < kGroup; first += kDoublesAtOnce) {
        const auto some = static_cast<std::uint32_t>((mask >> first) & kSome);
        if (std::popcount(some) < kWorthInPlace) continue;
        const auto one = static_cast<std::size_t>(std::countr_zero(some));
        const std::uint32_t object = search.candidate_of(first + one).object;
        const auto* rectangle = std::get_if<Rectangle>(&state.scene->objects[object].shape);
        const Instance& instance = state.instances[object];
        if (rectangle == nullptr || !instance.identity || instance.holes) continue;
        std::uint32_t alike = 0;
        each_bit(some, [&](std::size_t lane) HWY_ATTR {
            alike |= (search.candidate_of(first + lane).object == object ? 1u : 0u) << lane;
        });
        if (std::popcount(alike) < kWorthInPlace) continue;
        left |= rectangles.decide_in_place(world, first, alike, *rectangle, hits);
        mask &= ~(RayMask{alike} << first);
    }
    return left;
}

// The candidates of rays without rivals as far as they are cones, spheres and rectangles; the other
// rays stay in the mask that it returns. `world` holds the rays.
inline RayMask decide_sole_elements(const AccelState& state, const ClosestOfGroup& search,
                                    RayMask mask, const GroupRays& world, std::span<const Ray> rays,
                                    const RayQuery& query, std::span<Hit> hits) {
    SoleCones cones(state, search, rays, query);
    SoleSpheres spheres(state, search, rays, query);
    SoleRectangles rectangles(state, search, rays, query);
    RayMask left = decide_rectangles_in_place(state, search, mask, world, rectangles, hits);
    for (; mask != 0; mask &= mask - 1) {
        const auto ray = static_cast<std::size_t>(std::countr_zero(mask));
        if (!cones.add(ray) && !spheres.add(ray) && !rectangles.add(ray)) {
            left |= RayMask{1} << ray;
        }
        if (cones.full()) left |= cones.decide(hits);
        if (spheres.full()) left |= spheres.decide(hits);
        if (rectangles.full()) left |= rectangles.decide(hits);
    }
    return left | cones.rest(hits) | spheres.rest(hits) | rectangles.rest(hits);
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
