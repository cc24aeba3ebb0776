// What a group's rays have found so far. Included once for each instruction set.
#if defined(RAYPICK_GROUP_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_SEARCH_INL_H
#undef RAYPICK_GROUP_SEARCH_INL_H
#else
#define RAYPICK_GROUP_SEARCH_INL_H
#endif

#include "tracer/accel/searches.h"
#include "tracer/accel/simd/ray_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// Wider than a tie's window and what rounding adds to it.
inline constexpr float kBeyondTie = 1.0f + 0x1p-18f;

// The closest hits of a group. What float bounds make sure of needs no more than its number until
// the end: then the one scalar test works out its t. A ray's first such candidate, or one that
// surely stands before it, is kept in place; others that may win as well are `rivals`.
struct ClosestOfGroup {
    // Without defaults, as most are never used.
    struct Rival {
        std::uint32_t ray;
        std::uint32_t object;  // index
        std::uint32_t primitive;
    };
    static constexpr std::size_t kMostRivals = 256;

    GroupLimits limits;
    HWY_ALIGN GroupFloats candidate_from;  // t is at least this; infinite if there is none
    HWY_ALIGN std::array<std::uint32_t, kGroup> candidate_object;  // index
    HWY_ALIGN std::array<std::uint32_t, kGroup> candidate_primitive;
    RayMask found = 0;  // rays with a candidate
    RayMask rivalled = 0;
    RayMask lost = 0;  // rays with too many rivals, to be traced one by one
    std::array<Rival, kMostRivals> rivals;
    std::size_t rival_count = 0;

    void add_rival(std::size_t ray, std::uint32_t object, std::uint32_t primitive) {
        rivalled |= RayMask{1} << ray;
        if (rival_count == kMostRivals) {
            lost |= RayMask{1} << ray;
            limits.t_far[ray] = -std::numeric_limits<float>::infinity();
            return;
        }
        rivals[rival_count++] = {static_cast<std::uint32_t>(ray), object, primitive};
    }

    // A hit at t that the scalar code found, within t_far. It is found again in the end.
    void offer(std::size_t ray, std::uint32_t object, std::uint32_t primitive, float t) {
        const float window = tie_limit(t);
        limits.t_far[ray] = std::min(limits.t_far[ray], window);
        if (!(window * kBeyondTie < candidate_from[ray])) {
            add_rival(ray, object, primitive);
            return;
        }
        candidate_from[ray] = t;
        candidate_object[ray] = object;
        candidate_primitive[ray] = primitive;
        found |= RayMask{1} << ray;
    }
};

// Which rays of a group hit anything.
struct AnyOfGroup {
    GroupLimits limits;
    RayMask blocked = 0;

    void block(RayMask rays) {
        blocked |= rays;
        each_ray(rays, [&](std::size_t ray) HWY_ATTR {
            limits.t_far[ray] = -std::numeric_limits<float>::infinity();
        });
    }
};

// One ray of a group as the single-ray code searches for it in an object.
struct ClosestOfOne {
    ClosestOfGroup& group;
    std::size_t ray;
    std::uint32_t object;  // index

    [[nodiscard]] float limit() const { return group.limits.t_far[ray]; }
    bool offer(const Hit& hit) {
        group.offer(ray, object, hit.primitive, hit.t);
        return false;
    }
};
struct AnyOfOne {
    AnyOfGroup& group;
    std::size_t ray;

    [[nodiscard]] float limit() const { return group.limits.t_far[ray]; }
    bool offer(const Hit&) {
        group.block(RayMask{1} << ray);
        return true;
    }
};

}  // namespace raypick::HWY_NAMESPACE
namespace raypick {
template <>
inline constexpr bool kKeepsHits<HWY_NAMESPACE::ClosestOfOne> = false;
template <>
inline constexpr bool kKeepsHits<HWY_NAMESPACE::AnyOfOne> = false;
}  // namespace raypick
namespace raypick::HWY_NAMESPACE {

inline ClosestOfOne one_of(ClosestOfGroup& group, std::size_t ray, std::uint32_t object) {
    return {group, ray, object};
}
inline AnyOfOne one_of(AnyOfGroup& group, std::size_t ray, std::uint32_t /*object*/) {
    return {group, ray};
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
