// What surface points of all kinds of shapes have in common, several hits at a time. The steps are
// those of surface.cpp and local_point.cpp one by one, in double, so that no bit differs. Included
// once for each instruction set.
#if defined(RAYPICK_SURFACE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_SURFACE_LANES_INL_H
#undef RAYPICK_SURFACE_LANES_INL_H
#else
#define RAYPICK_SURFACE_LANES_INL_H
#endif

#include "tracer/accel/simd/double_vectors-inl.h"
#include "tracer/accel/surface_rows.h"

#include <cstddef>
#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE DoubleVector number(double x) {
    return hn::Set(Doubles(), x);
}
HWY_INLINE DoubleVector largest(const DoubleVector3& a) {
    const DoubleVector3 s = size(a);
    return larger(larger(s.x, s.y), s.z);
}
// Rim of local_point.cpp, of a point that is `away` from the origin.
HWY_INLINE DoubleVector rim_at(DoubleVector away) {
    return hn::Mul(number(64.0),
                   hn::Add(hn::Mul(away, number(0x1p-24)), hn::Mul(away, number(0x1p-47))));
}

// As many of the hits as a vector holds, from lane i on.
class SurfaceLanes {
public:
    HWY_INLINE SurfaceLanes(SurfaceRows& rows, std::size_t i) : rows_(rows), i_(i) {}

    HWY_INLINE DoubleVector of_ray(std::size_t row) const {
        return hn::PromoteTo(Doubles(), hn::LoadU(kFloats, at(row)));
    }
    HWY_INLINE DoubleVector3 of_ray3(std::size_t first) const {
        return {of_ray(first), of_ray(first + 1), of_ray(first + 2)};
    }

    // With the bound on its error; `magnitude` as in LocalPoint.
    HWY_INLINE void store_position(const DoubleVector3& position, DoubleVector magnitude) const {
        const DoubleVector3 reach = size(position);
        const auto bound = [&](std::size_t row, DoubleVector along) HWY_ATTR {
            const auto rounded =
                hn::DemoteTo(kFloats, hn::Add(hn::Mul(along, number(0x1p-24)),
                                              hn::Mul(hn::Add(along, magnitude), number(0x1p-47))));
            const auto least = hn::Set(kFloats, std::numeric_limits<float>::min());
            hn::StoreU(hn::Add(rounded, least), kFloats, at(SurfaceRows::kError + row));
        };
        store3(SurfaceRows::kPosition, position);
        bound(0, reach.x);
        bound(1, reach.y);
        bound(2, reach.z);
    }
    HWY_INLINE void store3(std::size_t first, const DoubleVector3& a) const {
        hn::StoreU(hn::DemoteTo(kFloats, a.x), kFloats, at(first));
        hn::StoreU(hn::DemoteTo(kFloats, a.y), kFloats, at(first + 1));
        hn::StoreU(hn::DemoteTo(kFloats, a.z), kFloats, at(first + 2));
    }

private:
    static constexpr hn::Rebind<float, Doubles> kFloats{};

    [[nodiscard]] HWY_INLINE float* at(std::size_t row) const {
        return &rows_.row[row * SurfaceRows::kLanes + i_];
    }

    SurfaceRows& rows_;
    std::size_t i_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
