#include "tracer/accel/same_corners.h"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/same_corners.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
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

// Of the corners up to i, and perhaps of some more. All are compared at once: which of them it is
// can't be foretold, so that a loop that ends there would be costly.
HWY_INLINE std::uint32_t corners_at_place_of(std::size_t i, const CornerPlaces& places) {
    const Tag d;
    const auto& [x, y, z] = places.along;
    const auto at_x = hn::Set(d, x[i]);
    const auto at_y = hn::Set(d, y[i]);
    const auto at_z = hn::Set(d, z[i]);
    std::uint32_t same = 0;
    for (std::size_t v = 0; v <= i; v += hn::Lanes(d)) {
        const auto equal =
            hn::And(hn::Eq(at_x, hn::Load(d, &x[v])),
                    hn::And(hn::Eq(at_y, hn::Load(d, &y[v])), hn::Eq(at_z, hn::Load(d, &z[v]))));
        same |= bits_of_mask(equal) << v;
    }
    return same;
}

HWY_INLINE SharedCorners number_corners(const CornerPlaces& places, std::size_t triangles) {
    SharedCorners shared;
    for (std::size_t i = 0; i < triangles; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t corner = 3 * i + k;
            const std::uint32_t same = corners_at_place_of(corner, places);
            const std::uint32_t first = same & (0u - same);
            const auto number =
                static_cast<std::uint32_t>(std::popcount(shared.firsts & (first - 1u)));
            shared.firsts |= first & 1u << corner;
            shared.number[k] |= (number & 15u) << (4 * i);
        }
    }
    shared.triangles = static_cast<std::uint32_t>(triangles);
    shared.count = static_cast<std::uint32_t>(std::popcount(shared.firsts));
    return shared;
}

// Takes the last triangle away.
HWY_INLINE void drop_triangle(SharedCorners& shared) {
    --shared.triangles;
    shared.firsts &= (1u << (3 * shared.triangles)) - 1u;
    for (std::uint32_t& number : shared.number)
        number &= (1u << (4 * shared.triangles)) - 1u;
    shared.count = static_cast<std::uint32_t>(std::popcount(shared.firsts));
}

HWY_INLINE void write_along(const std::array<std::uint32_t, 32>& along, std::uint32_t firsts,
                            std::uint32_t* out) {
    const Tag d;
    for (std::size_t v = 0; v < CornerPlaces::kMost; v += hn::Lanes(d)) {
        const std::uint32_t lanes = firsts >> v & ((1u << hn::Lanes(d)) - 1u);
        std::array<std::uint8_t, 8> bits{};
        std::memcpy(bits.data(), &lanes, sizeof lanes);
        hn::StoreU(hn::CompressBits(hn::Load(d, &along[v]), bits.data()), d, out);
        out += std::popcount(lanes);
    }
}

SharedCorners share_corners(const CornerPlaces& places, std::size_t triangles, std::uint32_t* out) {
    constexpr std::uint32_t kMostCorners = 16;
    SharedCorners shared = number_corners(places, triangles);
    while (shared.count > kMostCorners)
        drop_triangle(shared);
    out += shared.triangles;
    for (const auto& along : places.along) {
        write_along(along, shared.firsts, out);
        out += shared.count;
    }
    return shared;
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raypick {

HWY_EXPORT(share_corners);

SharedCorners share_corners(const CornerPlaces& places, std::size_t triangles, std::uint32_t* out) {
    return HWY_DYNAMIC_DISPATCH(share_corners)(places, triangles, out);
}

}  // namespace raypick
#endif
