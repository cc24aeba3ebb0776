#include "tracer/accel/same_corners.h"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/same_corners.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "tracer/accel/simd/packing-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<std::uint32_t, 16>;

template <typename Mask>
HWY_INLINE std::uint32_t bits_of_mask(Mask mask) {
    const Tag d;
    std::array<std::uint8_t, 8> bytes;
    hn::StoreMaskBits(d, mask, bytes.data());
    std::uint32_t bits = 0;
    std::memcpy(&bits, bytes.data(), (hn::MaxLanes(d) + 7) / 8);
    return bits;
}

// For each corner, a bit for each one that is at its place, those behind it not all. All are
// compared at once: which of them it is can't be foretold, so that a loop that ends there would be
// costly.
using SameCorners = std::array<std::uint32_t, CornerPlaces::kMost>;

HWY_INLINE void find_same(const CornerPlaces& places, std::size_t count, SameCorners& same) {
    const Tag d;
    const auto& [x, y, z] = places.along;
    for (std::size_t v = 0; v < count; v += hn::Lanes(d)) {
        const auto others_x = hn::Load(d, &x[v]);
        const auto others_y = hn::Load(d, &y[v]);
        const auto others_z = hn::Load(d, &z[v]);
        for (std::size_t i = v; i < count; ++i) {
            const auto equal = hn::And(
                hn::Eq(hn::Set(d, x[i]), others_x),
                hn::And(hn::Eq(hn::Set(d, y[i]), others_y), hn::Eq(hn::Set(d, z[i]), others_z)));
            const std::uint32_t bits = bits_of_mask(equal) << v;
            same[i] = v == 0 ? bits : same[i] | bits;
        }
    }
}

// The numbers of all corners, and the corners that are the first at their place, as bits.
struct Numbers {
    std::array<std::uint32_t, 3> corner{};  // as in a patch
    std::uint32_t firsts = 0;
};

HWY_INLINE Numbers number_corners(const SameCorners& same, std::size_t triangles) {
    Numbers numbers;
    for (std::size_t i = 0; i < triangles; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t corner = 3 * i + k;
            const std::uint32_t first = same[corner] & (0u - same[corner]);
            const auto number =
                static_cast<std::uint32_t>(std::popcount(numbers.firsts & (first - 1u)));
            numbers.firsts |= first & 1u << corner;
            numbers.corner[k] |= (number & 15u) << (4 * i);
        }
    }
    return numbers;
}

// How many of the triangles have no more corners than a patch has place for.
HWY_INLINE std::uint32_t triangles_that_fit(const Numbers& numbers, std::size_t triangles) {
    auto fit = static_cast<std::uint32_t>(triangles);
    std::uint32_t firsts = numbers.firsts;
    while (static_cast<std::uint32_t>(std::popcount(firsts)) > TrianglePatch::kMostCorners)
        firsts &= (1u << (3 * --fit)) - 1u;
    return fit;
}

HWY_INLINE void write_along(const std::array<std::uint32_t, 32>& along, std::uint32_t firsts,
                            std::uint32_t* out) {
    const Tag d;
    for (std::size_t v = 0; v < CornerPlaces::kMost; v += hn::Lanes(d)) {
        const std::uint32_t lanes = firsts >> v & ((1u << hn::Lanes(d)) - 1u);
        std::array<std::uint8_t, 8> bits{};
        std::memcpy(bits.data(), &lanes, sizeof lanes);
        const Packing<Tag> chosen(hn::LoadMaskBits(d, bits.data()));
        hn::StoreU(chosen.of(hn::Load(d, &along[v])), d, out);
        out += chosen.count();
    }
}

SharedCorners share_corners(const CornerPlaces& places, std::size_t triangles,
                            TrianglePatch& patch) {
    SameCorners same;
    find_same(places, 3 * triangles, same);
    const Numbers numbers = number_corners(same, triangles);
    const std::uint32_t fit = triangles_that_fit(numbers, triangles);
    const std::uint32_t firsts = numbers.firsts & ((1u << (3 * fit)) - 1u);
    const auto corners = static_cast<std::uint32_t>(std::popcount(firsts));
    for (std::size_t k = 0; k < 3; ++k)
        patch.corner[k] = numbers.corner[k] & static_cast<std::uint32_t>((1ull << (4 * fit)) - 1u);
    auto* out = reinterpret_cast<std::uint32_t*>(&patch + 1) + fit;
    for (const auto& along : places.along) {
        write_along(along, firsts, out);
        out += corners;
    }
    return {fit, corners};
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raypick {

HWY_EXPORT(share_corners);

SharedCorners share_corners(const CornerPlaces& places, std::size_t triangles,
                            TrianglePatch& patch) {
    return HWY_DYNAMIC_DISPATCH(share_corners)(places, triangles, patch);
}

}  // namespace raypick
#endif
