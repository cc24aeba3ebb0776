// Hits of rays side by side, written at once where the processor can. Included once for each
// instruction set.
#if defined(RAYPICK_HIT_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_HIT_ROWS_INL_H
#undef RAYPICK_HIT_ROWS_INL_H
#else
#define RAYPICK_HIT_ROWS_INL_H
#endif

#include "tracer/accel/hit.h"
#include "tracer/accel/simd/decide_triangles-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using HitNumbers = hn::Rebind<std::uint32_t, Doubles>;

// What as many rays hit as are decided at once, number by number.
struct HitColumns {
    hn::Vec<HitNumbers> object;  // its id
    hn::Vec<HitNumbers> primitive;
    const TriangleAnswers& answers;
};

#if HWY_TARGET <= HWY_AVX3

inline constexpr std::uint32_t kHitColumns = 6;
inline constexpr std::uint32_t kHitRows = 8;
static_assert(sizeof(Hit) == kHitColumns * 4 && offsetof(Hit, object) == 0 &&
              offsetof(Hit, primitive) == 4 && offsetof(Hit, t) == 8 && offsetof(Hit, uv) == 12 &&
              offsetof(Hit, front_face) == 20);

// Sets the mask's rows to sixteen numbers at a time, of which part(k) gives the ones from 16 k on.
template <typename Part>
HWY_INLINE void set_rows(std::uint64_t mask, Hit* rows, const Part& part) {
    const std::uint64_t numbers = _pdep_u64(mask, 0x041041041041) * 0x3f;  // six bits for each
    auto* const to = reinterpret_cast<std::uint32_t*>(rows);
    for (std::size_t k = 0; k < 3; ++k)
        _mm512_mask_storeu_epi32(to + 16 * k, static_cast<__mmask16>(numbers >> (16 * k)), part(k));
}

// Where the numbers of eight hits in a row come from: two at a time are the halves of a vector.
struct HitPlaces {
    using Places = std::array<std::uint32_t, 16>;

    HWY_ALIGN std::array<Places, 3> of_first_four;  // columns
    HWY_ALIGN std::array<Places, 3> with_others;    // of what that makes and the last two columns

    constexpr HitPlaces() : of_first_four{}, with_others{} {
        for (std::uint32_t k = 0; k < kHitColumns * kHitRows; ++k) {
            const std::uint32_t column = k % kHitColumns;
            const std::uint32_t at = column % 2 * kHitRows + k / kHitColumns;
            const bool first_four = column < 4;
            of_first_four[k / 16][k % 16] = first_four ? at + column / 2 * 16 : 0;
            with_others[k / 16][k % 16] = first_four ? k % 16 : at + 16;
        }
    }
};
inline constexpr HitPlaces kHitPlaces;

// Sets the hits of the mask's lanes.
HWY_INLINE void set_hits(const HitColumns& columns, std::uint64_t mask, Hit* hits) {
    const HitNumbers half;
    const hn::CappedTag<std::uint32_t, 16> d;
    const auto load = [&](const TriangleAnswers::Numbers& numbers) HWY_ATTR {
        return hn::BitCast(half, hn::Load(hn::RebindToFloat<HitNumbers>(), numbers.data()));
    };
    const auto front = hn::IfThenElseZero(mask_of_bits(half, columns.answers.front),
                                          hn::Set(half, std::uint32_t{1}));
    const auto first = hn::Combine(d, columns.primitive, columns.object);
    const auto second = hn::Combine(d, load(columns.answers.u), load(columns.answers.t));
    const auto third = hn::Combine(d, front, load(columns.answers.v));
    set_rows(mask, hits, [&](std::size_t k) HWY_ATTR {
        const auto in_first_four = hn::Load(d, kHitPlaces.of_first_four[k].data());
        const auto in_all = hn::Load(d, kHitPlaces.with_others[k].data());
        const auto some = _mm512_permutex2var_epi32(first.raw, in_first_four.raw, second.raw);
        return _mm512_permutex2var_epi32(some, in_all.raw, third.raw);
    });
}

// Sets the hits of the mask's rays to none.
HWY_INLINE void set_missed(RayMask mask, Hit* hits) {
    static constexpr std::array<Hit, kHitRows> kNone{};
    const hn::CappedTag<std::uint32_t, 16> d;
    const auto* const none = reinterpret_cast<const std::uint32_t*>(kNone.data());
    for (std::size_t first = 0; mask != 0; mask >>= kHitRows, first += kHitRows) {
        set_rows(mask & 0xff, hits + first,
                 [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, none + 16 * k).raw; });
    }
}

#else

HWY_INLINE void set_hits(const HitColumns& columns, std::uint64_t mask, Hit* hits) {
    const HitNumbers d;
    HWY_ALIGN std::array<std::uint32_t, kDoublesAtOnce> object;
    HWY_ALIGN std::array<std::uint32_t, kDoublesAtOnce> primitive;
    hn::Store(columns.object, d, object.data());
    hn::Store(columns.primitive, d, primitive.data());
    const TriangleAnswers& answers = columns.answers;
    for (std::size_t lane = 0; lane < kDoublesAtOnce; ++lane) {
        if (((mask >> lane) & 1) == 0) continue;
        hits[lane] = {object[lane],
                      primitive[lane],
                      answers.t[lane],
                      {answers.u[lane], answers.v[lane]},
                      answers.hits_front(lane)};
    }
}

HWY_INLINE void set_missed(RayMask mask, Hit* hits) {
    each_ray(mask, [&](std::size_t ray) HWY_ATTR { hits[ray] = Hit{}; });
}

#endif

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
