// What a group's rays have found so far. Included once for each instruction set.
#if defined(RAYPICK_GROUP_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_GROUP_SEARCH_INL_H
#undef RAYPICK_GROUP_SEARCH_INL_H
#else
#define RAYPICK_GROUP_SEARCH_INL_H
#endif

#include "tracer/accel/accel_state.h"
#include "tracer/accel/searches.h"
#include "tracer/accel/simd/decide_triangles-inl.h"
#include "tracer/accel/simd/ray_group-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

// Wider than a tie's window and what rounding adds to it.
inline constexpr float kBeyondTie = 1.0f + 0x1p-18f;

// What some rays of a group surely meet, and perhaps hit.
struct Candidate {
    std::uint32_t object;  // index
    std::uint32_t primitive;
    // Of a triangle, kept as long as they are at hand, in the instance's space. Null: they weren't.
    const Instance* instance;
    TriangleCorners corners;
};

// A ray of a group, and what it may hit. Without defaults, as most are never used.
struct RayAndPrimitive {
    std::uint32_t ray;
    std::uint32_t object;  // index
    std::uint32_t primitive;
};

// The closest hits of a group. What float bounds make sure of needs no more than its number until
// the end: then the one scalar test works out its t. A ray's first such candidate, or one that
// surely stands before it, is kept in place; others that may win as well are `rivals`.
struct ClosestOfGroup {
    static constexpr std::size_t kMostRivals = 256;
    static constexpr std::uint32_t kMostCandidates = 128;

    GroupLimits limits;
    HWY_ALIGN GroupFloats candidate_from;  // t is at least this; infinite if there is none
    HWY_ALIGN std::array<std::uint32_t, kGroup> candidate;  // its place in `candidates`
    // Behind the shared ones each ray has a place of its own.
    static constexpr std::size_t kPlaces = kMostCandidates + kGroup;
    HWY_ALIGN std::array<Candidate, kPlaces> candidates;
    std::uint32_t candidate_count = 0;
    RayMask found = 0;         // rays with a candidate
    RayMask in_own_place = 0;  // rays that had their candidate there at some time
    RayMask rivalled = 0;
    RayMask lost = 0;  // rays with too many rivals, to be traced one by one
    std::array<RayAndPrimitive, kMostRivals> rivals;
    std::size_t rival_count = 0;

    [[nodiscard]] const GroupLimits& limits_in(const GroupSpace& /*space*/) const { return limits; }
    [[nodiscard]] const Candidate& candidate_of(std::size_t ray) const {
        return candidates[candidate[ray]];
    }
    [[nodiscard]] bool full() const { return candidate_count == kMostCandidates; }

    // Only while it isn't full.
    Candidate& add_candidate(std::uint32_t object, std::uint32_t primitive) {
        Candidate& added = candidates[candidate_count++];
        added.object = object;
        added.primitive = primitive;
        added.instance = nullptr;
        return added;
    }

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
        if (!(window * kBeyondTie < candidate_from[ray]) || full()) {
            add_rival(ray, object, primitive);
            return;
        }
        candidate_from[ray] = t;
        candidate[ray] = candidate_count;
        add_candidate(object, primitive);
        found |= RayMask{1} << ray;
    }
};

// Leaves that blocked rays of the last groups, and are likely to block the next one's, too
// (Haines, Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", 1986).
class Blockers {
public:
    [[nodiscard]] std::span<const TopEntry> leaves() const { return {leaves_.data(), count_}; }

    // `leaf` is given as a part of its object.
    void add(const TopEntry& leaf) {
        for (const TopEntry& known : leaves()) {
            if (known == leaf) return;
        }
        leaves_[next_] = leaf;
        next_ = (next_ + 1) % kMost;
        count_ = std::min(count_ + 1, kMost);
    }

private:
    static constexpr std::size_t kMost = 4;

    std::array<TopEntry, kMost> leaves_;
    std::size_t count_ = 0;
    std::size_t next_ = 0;  // takes the oldest one's place
};

// Which rays of a group hit anything.
struct AnyOfGroup {
    // A leaf that blocks fewer rays of a vector isn't worth being tried first. Never as few as are
    // blocked where no leaf is searched, which is one at a time.
    static constexpr int kFewestBlocked = kAtOnce / 2;
    static_assert(kAtOnce == 1 || kFewestBlocked > 1);

    GroupLimits limits;
    GroupLimits back;  // of the same rays backwards; in use where they are followed so
    RayMask blocked = 0;
    TopEntry leaf;                 // that is searched, while several rays are followed at a time
    Blockers* blockers = nullptr;  // keeps such leaves, if it is not null

    [[nodiscard]] const GroupLimits& limits_in(const GroupSpace& space) const {
        return space.course.backwards() ? back : limits;
    }

    void block(RayMask rays) {
        blocked |= rays;
        if (kAtOnce > 1 && std::popcount(rays) >= kFewestBlocked && blockers != nullptr)
            blockers->add(leaf);
        const Rays d;
        const auto nowhere = hn::Set(d, -std::numeric_limits<float>::infinity());
        each_vector(rays, [&](std::size_t ray, RayMask bits) HWY_ATTR {
            for (GroupFloats* t_far : {&limits.t_far, &back.t_far}) {
                float* const at = t_far->data() + ray;
                hn::Store(hn::IfThenElse(ray_mask(bits), nowhere, hn::Load(d, at)), d, at);
            }
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
inline void set_object(ClosestOfOne& one, std::uint32_t object) {
    one.object = object;
}

// True if the group takes note of the primitive for rays that may hit it, and lets them go on. Most
// don't: see group_crossings-inl.h.
template <typename Group>
HWY_INLINE bool crossed(Group& /*group*/, std::uint32_t /*object*/, std::uint32_t /*primitive*/,
                        RayMask /*rays*/) {
    return false;
}

// A hit within the ray's interval that counts, unless one before it is sought and there.
template <typename Group>
HWY_INLINE void offer_hit(Group& search, std::size_t ray, std::uint32_t object,
                          std::uint32_t primitive, float t) {
    if (crossed(search, object, primitive, RayMask{1} << ray)) return;
    if constexpr (!std::is_same_v<Group, ClosestOfGroup>) {
        search.block(RayMask{1} << ray);
    } else if (t <= search.limits.t_far[ray]) {
        search.offer(ray, object, primitive, t);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
