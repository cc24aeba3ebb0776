// Groups of rays that follow one another, and what they share of their ways through trees. Included
// once for each instruction set.
#if defined(RAYPICK_RAY_RUN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_RUN_INL_H
#undef RAYPICK_RAY_RUN_INL_H
#else
#define RAYPICK_RAY_RUN_INL_H
#endif

#include "tracer/accel/accel_state.h"
#include "tracer/accel/simd/group_back-inl.h"
#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/accel/simd/ray_group-inl.h"
#include "tracer/accel/tree_memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Neighbouring groups go similar ways: once one of them has opened many nodes of a tree, those that
// follow begin where all of them may go on. Some of the rays say what all are like, and each group
// is asked whether it is like them.
class RayRun {
public:
    static constexpr std::size_t kMostRays = 16 * kGroup;

    // A tree, or a part of one, that many nodes of were opened.
    struct Place {
        TopEntry entry;  // nobody's in the top tree
        std::optional<EntryPoints> points;
    };

    // Of up to kMostRays rays. `end`: where they end, if it isn't null, and may be followed
    // backwards from. All must outlive it.
    RayRun(const AccelState& state, std::span<const Ray> rays, const glm::vec3* end)
        : state_(state), rays_(rays), end_(end) {}

    // Null if it isn't one.
    [[nodiscard]] HWY_INLINE Place* find(const TopEntry& entry) {
        for (std::size_t i = 0; i < count_; ++i) {
            if (places_[i].entry == entry) return &places_[i];
        }
        return nullptr;
    }

    // Where the rays of a group begin there, as the world's space sees them; null: at its root.
    [[nodiscard]] HWY_INLINE const EntryPoints* points(const GroupSpace& space,
                                                       Place& place) const {
        if (!holds(space)) return nullptr;
        if (!place.points) set(place);
        return &*place.points;
    }

    // A group opened so many nodes of what is no place yet.
    HWY_INLINE void opened(const GroupSpace& space, const TopEntry& entry, std::uint32_t nodes) {
        if (nodes >= kWorthwhile && count_ < most_ && goes_this_way(space)) add(entry);
    }

private:
    // Fewer rays or opened nodes aren't worth it.
    static constexpr std::size_t kFewestRays = 4 * kGroup;
    static constexpr std::uint32_t kWorthwhile = 6;
    static constexpr std::size_t kMostPlaces = 4;

    // The rays that say what a group is like: corners of 8 x 8 pixels, as pixels_in_squares() has
    // them.
    static constexpr std::array<std::size_t, 4> kCorners = {0, 19, 44, 63};

    HWY_NOINLINE void add(const TopEntry& entry) {
        if (count_ == 0 && !measure()) {
            most_ = 0;
        } else {
            places_[count_++].entry = entry;
        }
    }

    HWY_NOINLINE void set(Place& place) const {
        const TopEntry& entry = place.entry;
        place.points.emplace(entry.object == kNobody
                                 ? TreeMemory(state_.top)
                                 : TreeMemory(*state_.instances[entry.object].tree),
                             entry.part, bounds_, t_least_);
    }

    // Backwards or not.
    [[nodiscard]] bool goes_this_way(const GroupSpace& space) const {
        return space.course.backwards() == (end_ != nullptr);
    }

    // Arranged so that a NaN makes it false.
    [[nodiscard]] bool holds(const GroupSpace& space) const {
        bool all = space.octant == bounds_.octant && goes_this_way(space);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            all &= space.origin_low[axis] >= bounds_.origin_low[axis];
            all &= space.origin_high[axis] <= bounds_.origin_high[axis];
            all &= space.direction_low[axis] >= bounds_.direction_low[axis];
            all &= space.direction_high[axis] <= bounds_.direction_high[axis];
        }
        return all;
    }

    // False if the rays are too few or too different.
    bool measure() {
        if (rays_.size() < kFewestRays) return false;
        Row low;
        Row high;
        find_least_and_most(low, high);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float least = low[3 + axis];
            const float most = high[3 + axis];
            if (!(least > 0.0f || most < 0.0f)) return false;  // in several octants
            if (!(std::abs(low[axis]) < kFarthestReach && std::abs(high[axis]) < kFarthestReach))
                return false;
            bounds_.origin_low[axis] = low[axis];
            bounds_.origin_high[axis] = high[axis];
            bounds_.direction_low[axis] = least;
            bounds_.direction_high[axis] = most;
        }
        std::optional<float> stray;
        if (end_ != nullptr) {
            turn_back();
            stray = GroupBack::most_stray(state_.reach);
            t_least_ = -2.0f * GroupBack::most_slack(state_.reach);
        }
        bounds_.set_planes(0.0f, state_.reach, stray);
        return true;
    }

    void turn_back() {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds_.origin_low[axis] = bounds_.origin_high[axis] = (*end_)[static_cast<int>(axis)];
            std::swap(bounds_.direction_low[axis], bounds_.direction_high[axis]);
            bounds_.direction_low[axis] = -bounds_.direction_low[axis];
            bounds_.direction_high[axis] = -bounds_.direction_high[axis];
        }
    }

    // A ray's numbers: origin, direction, t_min, t_max.
    using Row = std::array<float, 8>;

    // Of the groups' corners, and somewhat more. NaNs left aside.
    void find_least_and_most(Row& low, Row& high) const {
        static_assert(sizeof(Ray) == sizeof(Row));
        const hn::CappedTag<float, 8> d;
        constexpr std::size_t kLanes = hn::MaxLanes(hn::CappedTag<float, 8>());
        for (std::size_t k = 0; k < 8; k += kLanes) {
            auto least = hn::Set(d, std::numeric_limits<float>::infinity());
            auto most = hn::Neg(least);
            for (std::size_t first = 0; first + kGroup <= rays_.size(); first += kGroup) {
                for (const std::size_t i : kCorners) {
                    const auto* const numbers = reinterpret_cast<const float*>(&rays_[first + i]);
                    const auto row = hn::LoadU(d, numbers + k);
                    least = number_or_smaller(d, row, least);
                    most = number_or_larger(d, row, most);
                }
            }
            const auto more = hn::Mul(hn::Sub(most, least), hn::Set(d, 1.0f / 16.0f));
            hn::StoreU(hn::Sub(least, more), d, low.data() + k);
            hn::StoreU(hn::Add(most, more), d, high.data() + k);
        }
    }

    const AccelState& state_;
    std::span<const Ray> rays_;
    const glm::vec3* end_;
    GroupBounds bounds_;  // once there is a place
    float t_least_ = 0.0f;
    std::size_t count_ = 0;
    std::size_t most_ = kMostPlaces;
    std::array<Place, kMostPlaces> places_;
};

// Those from `first` on, which begin a run.
inline std::span<const Ray> rays_of_run(std::span<const Ray> rays, std::size_t first) {
    return rays.subspan(first, std::min(RayRun::kMostRays, rays.size() - first));
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
