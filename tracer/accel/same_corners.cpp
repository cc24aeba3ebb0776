#include "tracer/accel/same_corners.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/same_corners.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// All corners up to each one are compared at once: which of them it is can't be foretold, so that
// a loop that ends there would be costly.
void find_first_corners(const CornerPlaces& places, std::size_t count, FirstCorners& first) {
    const hn::CappedTag<std::uint32_t, 16> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto& [x, y, z] = places.along;
    for (std::size_t i = 0; i < count; ++i) {
        const auto at_x = hn::Set(d, x[i]);
        const auto at_y = hn::Set(d, y[i]);
        const auto at_z = hn::Set(d, z[i]);
        // The corner finds itself where none is before it.
        std::intptr_t best = 0;
        for (std::size_t v = i / lanes * lanes + lanes; v > 0;) {
            v -= lanes;
            const auto same = hn::And(
                hn::Eq(at_x, hn::Load(d, &x[v])),
                hn::And(hn::Eq(at_y, hn::Load(d, &y[v])), hn::Eq(at_z, hn::Load(d, &z[v]))));
            const std::intptr_t found = hn::FindFirstTrue(d, same);
            best = found >= 0 ? static_cast<std::intptr_t>(v) + found : best;
        }
        first[i] = static_cast<std::uint32_t>(best);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raypick {

HWY_EXPORT(find_first_corners);

void find_first_corners(const CornerPlaces& places, std::size_t count, FirstCorners& first) {
    HWY_DYNAMIC_DISPATCH(find_first_corners)(places, count, first);
}

}  // namespace raypick
#endif
