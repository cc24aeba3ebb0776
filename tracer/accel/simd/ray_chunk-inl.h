// Which rays go in groups. Included once for each instruction set.
#if defined(RAYPICK_RAY_CHUNK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_RAY_CHUNK_INL_H
#undef RAYPICK_RAY_CHUNK_INL_H
#else
#define RAYPICK_RAY_CHUNK_INL_H
#endif

#include "tracer/accel/accel_state.h"
#include "tracer/accel/passage.h"
#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/accel/simd/ray_group-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Fewer rays than that are no group, for they are quicker apart (see RaysApart). Rays that go all
// ways seldom have more in common than their octant. Of others, a group is better for spheres and
// cones as soon as it isn't given up at once.
inline int fewest_in_group(const AccelState& state, const std::array<RayMask, 8>& octants) {
    const auto ways =
        std::count_if(octants.begin(), octants.end(), [](RayMask group) { return group != 0; });
    if (ways > 6) return 24;
    return state.mostly_triangles ? 12 : kFewRays + 1;
}

// Rays as they come, and which of them can go in groups.
struct Chunk {
    GroupRays world;
    GroupLimits limits;
    std::array<RayMask, 8> octants{};
    RayMask apart = 0;  // they could go in groups, but have nothing in common
    RayMask alone = 0;

    Chunk(const AccelState& state, std::span<const Ray> rays, const RayQuery& query) {
        const bool plain = !query.accept && query.clip_planes.empty() &&
                           (state.top.empty() || state.reach < kFarthestReach);
        if (!plain) {
            for (std::size_t i = 0; i < rays.size(); ++i)
                alone |= RayMask{usable(rays[i]) ? 1u : 0u} << i;
            return;
        }
        if (kAtOnce > 1 && rays.size() == kGroup) {
            set_all(rays);
        } else {
            for (std::size_t i = 0; i < kGroup; ++i)
                set(i, i < rays.size() ? rays[i] : rays[0]);
        }
        const RayMask there = first_rays(rays.size());
        const RayMask groupable = there & ordinary();
        each_ray(there & ~groupable,
                 [&](std::size_t i) HWY_ATTR { alone |= RayMask{usable(rays[i]) ? 1u : 0u} << i; });
        world.invert();
        octants = world.octants(groupable);
        const int fewest = fewest_in_group(state, octants);
        for (RayMask& group : octants) {
            if (std::popcount(group) >= fewest) continue;
            apart |= group;
            group = 0;
        }
        if (state.has_spheres && apart != groupable) world.measure_lengths();
    }

private:
    // A ray's numbers are eight in a row: origin, direction, t_min, t_max.
    HWY_INLINE void set_all(std::span<const Ray> rays) {
        static_assert(sizeof(Ray) == 8 * sizeof(float) && offsetof(Ray, direction) == 12 &&
                      offsetof(Ray, t_min) == 24 && offsetof(Ray, t_max) == 28);
#if HWY_TARGET <= HWY_AVX3
        for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
            const auto* const numbers = reinterpret_cast<const float*>(&rays[i]);
            RayFloats a[4];  // numbers 0 to 3 of four rays each, number by number
            RayFloats b[4];  // numbers 4 to 7
            for (std::size_t k = 0; k < 4; ++k) {
                const auto two = hn::LoadU(Rays(), numbers + 32 * k);
                const auto more = hn::LoadU(Rays(), numbers + 32 * k + 16);
                a[k] = pick(two, more, 0);
                b[k] = pick(two, more, 4);
            }
            store_rows(a, {&world.origin[0][i], &world.origin[1][i], &world.origin[2][i],
                           &world.direction[0][i]});
            store_rows(b, {&world.direction[1][i], &world.direction[2][i], &limits.t_min[i],
                           &limits.t_far[i]});
        }
#elif HWY_TARGET != HWY_SCALAR
        const Rays d;
        for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
            // Of one half of them in turns: number k and number k + 4 of each ray.
            RayFloats a[4];
            RayFloats b[4];
            const auto* first = reinterpret_cast<const float*>(&rays[i]);
            const auto* second = reinterpret_cast<const float*>(&rays[i + kAtOnce / 2]);
            hn::LoadInterleaved4(d, first, a[0], a[1], a[2], a[3]);
            hn::LoadInterleaved4(d, second, b[0], b[1], b[2], b[3]);
            float* const low[4] = {&world.origin[0][i], &world.origin[1][i], &world.origin[2][i],
                                   &world.direction[0][i]};
            float* const high[4] = {&world.direction[1][i], &world.direction[2][i],
                                    &limits.t_min[i], &limits.t_far[i]};
            for (std::size_t k = 0; k < 4; ++k) {
                hn::Store(hn::ConcatEven(d, b[k], a[k]), d, low[k]);
                hn::Store(hn::ConcatOdd(d, b[k], a[k]), d, high[k]);
            }
        }
#else
        (void)rays;
#endif
    }

#if HWY_TARGET <= HWY_AVX3
    // Numbers from `first` on, four of each of the rays in two vectors, number by number.
    HWY_INLINE static RayFloats pick(RayFloats two_rays, RayFloats two_more, std::uint32_t first) {
        HWY_ALIGN static constexpr std::uint32_t kPlaces[16] = {0, 8,  16, 24, 1, 9,  17, 25,
                                                                2, 10, 18, 26, 3, 11, 19, 27};
        const hn::RebindToUnsigned<Rays> d;
        const auto places = hn::Add(hn::Load(d, kPlaces), hn::Set(d, first));
        return RayFloats{_mm512_permutex2var_ps(two_rays.raw, places.raw, two_more.raw)};
    }

    // Block k of all to row k.
    HWY_INLINE static void store_rows(const RayFloats (&from)[4],
                                      const std::array<float*, 4>& rows) {
        const auto low_a = _mm512_shuffle_f32x4(from[0].raw, from[1].raw, 0x44);
        const auto low_b = _mm512_shuffle_f32x4(from[2].raw, from[3].raw, 0x44);
        const auto high_a = _mm512_shuffle_f32x4(from[0].raw, from[1].raw, 0xee);
        const auto high_b = _mm512_shuffle_f32x4(from[2].raw, from[3].raw, 0xee);
        _mm512_store_ps(rows[0], _mm512_shuffle_f32x4(low_a, low_b, 0x88));
        _mm512_store_ps(rows[1], _mm512_shuffle_f32x4(low_a, low_b, 0xdd));
        _mm512_store_ps(rows[2], _mm512_shuffle_f32x4(high_a, high_b, 0x88));
        _mm512_store_ps(rows[3], _mm512_shuffle_f32x4(high_a, high_b, 0xdd));
    }
#endif

    HWY_INLINE void set(std::size_t i, const Ray& ray) {
        world.origin[0][i] = ray.origin.x;
        world.origin[1][i] = ray.origin.y;
        world.origin[2][i] = ray.origin.z;
        world.direction[0][i] = ray.direction.x;
        world.direction[1][i] = ray.direction.y;
        world.direction[2][i] = ray.direction.z;
        limits.t_min[i] = ray.t_min;
        limits.t_far[i] = ray.t_max;
    }

    // Usable, from t_min >= 0 on and not too far away for float; arranged so that a NaN is not.
    [[nodiscard]] RayMask ordinary() const {
        const Rays d;
        RayMask result = world.within(kFarthestReach, 0.5f, 2.0f);
        for (std::size_t i = 0; i < kGroup; i += kAtOnce) {
            const auto t_min = hn::Load(d, limits.t_min.data() + i);
            const auto t_far = hn::Load(d, limits.t_far.data() + i);
            const auto fine = hn::And(hn::Ge(t_min, hn::Zero(d)), hn::Lt(t_min, t_far));
            result &= ~(kAllAtOnce << i) | ray_bits(fine) << i;
        }
        return result;
    }
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
