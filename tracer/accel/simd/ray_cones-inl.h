// Single rays with cones, several pairs at a time, whichever rays and cones they are: see
// cone_bounds-inl.h. Included once for each instruction set.
#if defined(RAYPICK_RAY_CONES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_CONES_INL_H
#undef RAYPICK_RAY_CONES_INL_H
#else
#define RAYPICK_RAY_CONES_INL_H
#endif

#include "tracer/accel/simd/cone_bounds-inl.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/ray_verdict-inl.h"
#include "tracer/geometry/ray.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Up to kAtOnce rays, none beyond what bounds hold for, with a cone each. All cones are capped, or
// none.
class RayCones {
public:
    using Pairs = hn::CappedTag<float, RayVerdict::kMost>;
    static constexpr std::size_t kAtOnce = hn::MaxLanes(Pairs());

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] bool full() const { return count_ == kAtOnce; }
    // Whether a cone of this kind can be added, unless it is full.
    [[nodiscard]] bool takes(bool capped) const { return count_ == 0 || capped == capped_; }
    void clear() { count_ = 0; }

    // `ends` are base and apex, `steepest` is the direction's largest component, `limit` the
    // largest t of interest.
    HWY_INLINE void add(const Ray& ray, float steepest, float limit, const glm::vec4* ends,
                        bool capped) {
        const std::size_t i = count_++;
        put(i, 0, ends[0]);
        put(i, 4, ends[1]);
        put(i, 8, ray.origin);
        put(i, 11, ray.direction);
        row_[14][i] = steepest;
        row_[15][i] = ray.t_min;
        row_[16][i] = limit;
        capped_ = capped;
    }

    // Which of the rays hit their cones first, on either side.
    HWY_INLINE void judge(RayVerdict& verdict) const {
        const Pairs d;
        const auto row = [&](std::size_t i) HWY_ATTR { return hn::Load(d, row_[i].data()); };
        const auto cones = cone_lanes(d, row(0), row(1), row(2), row(3), row(4), row(5), row(6),
                                      row(7), hn::Zero(d));
        const RayLanes<hn::Vec<Pairs>> rays{row(8),  row(9),  row(10), row(11), row(12),
                                            row(13), row(14), row(15), row(16)};
        ConeBounds<Pairs> bounds(cones, rays);
        verdict.may = ((1u << count_) - 1u) & ~bits(bounds.passes_by());
        if (verdict.may == 0) return;
        bounds.estimate();
        verdict.may &= ~bits(bounds.misses());
        if (verdict.may == 0) return;
        const auto crossing = bounds.crossing(true, true, capped_);
        verdict.sure = verdict.may & bits(crossing.sure);
        hn::Store(crossing.from, d, verdict.from.data());
        hn::Store(crossing.to, d, verdict.to.data());
    }

private:
    template <glm::length_t N>
    HWY_INLINE void put(std::size_t i, std::size_t first, const glm::vec<N, float>& v) {
        for (glm::length_t k = 0; k < N; ++k)
            row_[first + static_cast<std::size_t>(k)][i] = v[k];
    }

    static HWY_INLINE std::uint32_t bits(const hn::Mask<Pairs>& mask) {
        return bits_of_mask(Pairs(), mask);
    }

    // Base and radius, apex and radius, origin, direction, steepest, t_min and t_far. What no pair
    // has set is no number that slows others down.
    HWY_ALIGN std::array<std::array<float, kAtOnce>, 17> row_{};
    std::size_t count_ = 0;
    bool capped_ = false;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
