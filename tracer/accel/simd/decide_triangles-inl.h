// intersect_triangle for several rays at once, each with a triangle of its own: the same operations
// on doubles in the same order, so that not a bit differs. Included once for each instruction set.
#if defined(RAYPICK_DECIDE_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_DECIDE_TRIANGLES_INL_H
#undef RAYPICK_DECIDE_TRIANGLES_INL_H
#else
#define RAYPICK_DECIDE_TRIANGLES_INL_H
#endif

#include "tracer/accel/passage.h"
#include "tracer/accel/simd/mask_bits-inl.h"
#include "tracer/accel/simd/ray_group-inl.h"
#include "tracer/geometry/ray.h"
#include "tracer/geometry/shapes.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using DoubleVector = hn::Vec<Doubles>;
inline constexpr std::size_t kDoublesAtOnce = hn::MaxLanes(Doubles());

// std::min and std::max, whatever the sign of a zero.
HWY_INLINE DoubleVector smaller(DoubleVector a, DoubleVector b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
    return hn::Min(b, a);
#else
    return hn::IfThenElse(hn::Lt(b, a), b, a);
#endif
}
HWY_INLINE DoubleVector larger(DoubleVector a, DoubleVector b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
    return hn::Max(b, a);
#else
    return hn::IfThenElse(hn::Lt(a, b), b, a);
#endif
}

// As many neighbours in a group are decided where they are, without a row for each.
inline constexpr int kWorthInPlace = kDoublesAtOnce > 2 ? 2 : 1;

// By corner and axis; the fourth is nobody's.
using TriangleCorners = std::array<std::array<float, 4>, 3>;
// A triangle for each lane.
using CornersOfLanes = std::array<const TriangleCorners*, kDoublesAtOnce>;

// Rays with a triangle each, a row for each pair: that is how they come.
struct TrianglePairs {
    using Row = std::array<double, 8>;       // origin, direction, and two that nobody asks for
    using CornerRow = std::array<float, 4>;  // and one that nobody asks for
    template <typename Element>
    using Rows = std::array<Element, kDoublesAtOnce>;
    HWY_ALIGN Rows<Row> rays;
    using CornerRows = std::array<Rows<CornerRow>, 3>;
    HWY_ALIGN CornerRows corners;

    // Of a triangle in world space.
    HWY_INLINE void set_ray(std::size_t lane, const Ray& ray) {
        static_assert(sizeof(Ray) == 8 * sizeof(float) && offsetof(Ray, direction) == 12);
        const Doubles d;
        const hn::Rebind<float, Doubles> of_float;
        const auto* numbers = reinterpret_cast<const float*>(&ray);
        for (std::size_t i = 0; i < 8; i += kDoublesAtOnce)
            hn::Store(hn::PromoteTo(d, hn::LoadU(of_float, numbers + i)), d, &rays[lane][i]);
    }

    HWY_INLINE void set_ray(std::size_t lane, const ObjectRay& ray) {
        rays[lane] = {ray.origin.x,    ray.origin.y,    ray.origin.z, ray.direction.x,
                      ray.direction.y, ray.direction.z, 0.0,          0.0};
    }

    HWY_INLINE void set_corners(std::size_t lane, const glm::vec3& a, const glm::vec3& b,
                                const glm::vec3& c) {
        corners[0][lane] = {a.x, a.y, a.z, 0.0f};
        corners[1][lane] = {b.x, b.y, b.z, 0.0f};
        corners[2][lane] = {c.x, c.y, c.z, 0.0f};
    }

    // The first pair once more, from this lane on.
    HWY_INLINE void fill_from(std::size_t lane) {
        for (; lane < kDoublesAtOnce; ++lane) {
            rays[lane] = rays[0];
            for (auto& corner : corners)
                corner[lane] = corner[0];
        }
    }
};

// The ray in the object's space.
HWY_INLINE void set_ray(const Instance& instance, const Ray& ray, std::size_t lane,
                        TrianglePairs& pairs) {
    if (instance.identity) {
        pairs.set_ray(lane, ray);
    } else {
        pairs.set_ray(lane, object_ray(instance, ray));
    }
}

// Pairs, number by number.
struct TriangleColumns {
    DoubleVector origin[3];
    DoubleVector direction[3];
    DoubleVector corner[3][3];  // by corner and axis

    // Of rays from `first` on, all with the same triangle.
    HWY_INLINE TriangleColumns(const GroupRays& rays, std::size_t first,
                               const TriangleCorners& corners) {
        set_rays(rays, first);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t k = 0; k < 3; ++k)
                corner[k][axis] = hn::Set(Doubles(), static_cast<double>(corners[k][axis]));
        }
    }

    // The same with a triangle each.
    HWY_INLINE TriangleColumns(const GroupRays& rays, std::size_t first,
                               const CornersOfLanes& corners) {
        for (std::size_t k = 0; k < 3; ++k)
            set_corner(corners, k);
        set_rays(rays, first);
    }

    HWY_INLINE explicit TriangleColumns(const TrianglePairs& pairs) {
        set_corners(pairs.corners);
#if HWY_TARGET == HWY_SCALAR
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis] = hn::Load(Doubles(), &pairs.rays[0][axis]);
            direction[axis] = hn::Load(Doubles(), &pairs.rays[0][3 + axis]);
        }
#else
        // Of one half of the rows in turns: number k and number k + 4.
        const Doubles d;
        DoubleVector a[4];
        DoubleVector b[4];
        hn::LoadInterleaved4(d, pairs.rays[0].data(), a[0], a[1], a[2], a[3]);
        hn::LoadInterleaved4(d, pairs.rays[kDoublesAtOnce / 2].data(), b[0], b[1], b[2], b[3]);
        origin[0] = hn::ConcatEven(d, b[0], a[0]);
        origin[1] = hn::ConcatEven(d, b[1], a[1]);
        origin[2] = hn::ConcatEven(d, b[2], a[2]);
        direction[0] = hn::ConcatEven(d, b[3], a[3]);
        direction[1] = hn::ConcatOdd(d, b[0], a[0]);
        direction[2] = hn::ConcatOdd(d, b[1], a[1]);
#endif
    }

private:
    HWY_INLINE void set_rays(const GroupRays& rays, std::size_t first) {
        const Doubles d;
        const hn::Rebind<float, Doubles> of_float;
        const auto load = [&](const GroupFloats& numbers) HWY_ATTR {
            return hn::PromoteTo(d, hn::LoadU(of_float, numbers.data() + first));
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis] = load(rays.origin[axis]);
            direction[axis] = load(rays.direction[axis]);
        }
    }

    HWY_INLINE void set_corner(const CornersOfLanes& corners, std::size_t k) {
#if HWY_TARGET <= HWY_AVX2
        // Straight from where they are: numbers that have just been stored one by one can't be
        // loaded several at once without waiting.
        const Doubles d;
        const hn::Rebind<float, Doubles> of_float;
        const hn::RepartitionToWide<decltype(of_float)> pairs;
        const hn::FixedTag<float, 4> row;
        const auto load = [&](std::size_t lane)
                              HWY_ATTR { return hn::LoadU(row, (*corners[lane])[k].data()); };
#if HWY_TARGET <= HWY_AVX3
        const auto rows = [&](std::size_t lane) HWY_ATTR {
            return hn::Combine(of_float, load(lane + 4), load(lane));
        };
#else
        const auto& rows = load;
#endif
        const auto a = rows(0);
        const auto b = rows(1);
        const auto c = rows(2);
        const auto e = rows(3);
        const auto low = [&](auto x, auto y) HWY_ATTR {
            return hn::BitCast(pairs, hn::InterleaveLower(of_float, x, y));
        };
        const auto high = [&](auto x, auto y) HWY_ATTR {
            return hn::BitCast(pairs, hn::InterleaveUpper(of_float, x, y));
        };
        const auto promote = [&](auto column) HWY_ATTR {
            return hn::PromoteTo(d, hn::BitCast(of_float, column));
        };
        corner[k][0] = promote(hn::InterleaveLower(pairs, low(a, b), low(c, e)));
        corner[k][1] = promote(hn::InterleaveUpper(pairs, low(a, b), low(c, e)));
        corner[k][2] = promote(hn::InterleaveLower(pairs, high(a, b), high(c, e)));
#else
        HWY_ALIGN TrianglePairs::Rows<TrianglePairs::CornerRow> rows;
        for (std::size_t lane = 0; lane < kDoublesAtOnce; ++lane)
            rows[lane] = (*corners[lane])[k];
        set_corner(rows, corner[k]);
#endif
    }

    HWY_INLINE void set_corners(const TrianglePairs::CornerRows& rows) {
        for (std::size_t k = 0; k < 3; ++k)
            set_corner(rows[k], corner[k]);
    }

    HWY_INLINE static void set_corner(const TrianglePairs::Rows<TrianglePairs::CornerRow>& rows,
                                      DoubleVector (&to)[3]) {
        const Doubles d;
        const hn::Rebind<float, Doubles> of_float;
        hn::Vec<hn::Rebind<float, Doubles>> column[4];
        hn::LoadInterleaved4(of_float, rows[0].data(), column[0], column[1], column[2], column[3]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            to[axis] = hn::PromoteTo(d, column[axis]);
    }
};

// Which axis is which in a ray's sheared space (see shear() in triangle_test.h): kz is where the
// direction is longest, and kx and ky are swapped where it is below 0 there.
struct ShearedAxes {
    hn::Mask<Doubles> x_is_0, x_is_1;  // else 2
    hn::Mask<Doubles> y_is_0, y_is_1;
    hn::Mask<Doubles> z_is_0, z_is_1;

    HWY_INLINE explicit ShearedAxes(const DoubleVector (&direction)[3]) {
        const auto x = hn::Abs(direction[0]);
        const auto y = hn::Abs(direction[1]);
        const auto z = hn::Abs(direction[2]);
        const auto beyond_y = hn::Gt(x, y);
        z_is_0 = hn::And(beyond_y, hn::Gt(x, z));
        z_is_1 = hn::AndNot(beyond_y, hn::Gt(y, z));
        const auto z_is_2 = hn::Not(hn::Or(z_is_0, z_is_1));
        const auto swapped = hn::Lt(pick(z_is_0, z_is_1, direction), hn::Zero(Doubles()));
        const auto either = [&](const auto& plain, const auto& if_swapped) HWY_ATTR {
            return hn::Or(hn::AndNot(swapped, plain), hn::And(swapped, if_swapped));
        };
        x_is_0 = either(z_is_2, z_is_1);
        x_is_1 = either(z_is_0, z_is_2);
        y_is_0 = either(z_is_1, z_is_2);
        y_is_1 = either(z_is_2, z_is_0);
    }

    [[nodiscard]] HWY_INLINE DoubleVector x_of(const DoubleVector (&v)[3]) const {
        return pick(x_is_0, x_is_1, v);
    }
    [[nodiscard]] HWY_INLINE DoubleVector y_of(const DoubleVector (&v)[3]) const {
        return pick(y_is_0, y_is_1, v);
    }
    [[nodiscard]] HWY_INLINE DoubleVector z_of(const DoubleVector (&v)[3]) const {
        return pick(z_is_0, z_is_1, v);
    }

private:
    HWY_INLINE static DoubleVector pick(const hn::Mask<Doubles>& is_0,
                                        const hn::Mask<Doubles>& is_1, const DoubleVector (&v)[3]) {
        return hn::IfThenElse(is_0, v[0], hn::IfThenElse(is_1, v[1], v[2]));
    }
};

// Rays as shear() has them: their directions, and ShearedRay::across by the same operations.
struct Shear {
    ShearedAxes axes;
    DoubleVector x, y, z;

    HWY_INLINE explicit Shear(const DoubleVector (&direction)[3])
        : axes(direction),
          x(axes.x_of(direction)),
          y(axes.y_of(direction)),
          z(axes.z_of(direction)) {}

    // Of a point seen from the ray's origin that is `ahead` along its last axis.
    HWY_INLINE DoubleVector across_x(const DoubleVector (&point)[3], DoubleVector ahead) const {
        return hn::Sub(hn::Mul(axes.x_of(point), z), hn::Mul(x, ahead));
    }
    HWY_INLINE DoubleVector across_y(const DoubleVector (&point)[3], DoubleVector ahead) const {
        return hn::Sub(hn::Mul(axes.y_of(point), z), hn::Mul(y, ahead));
    }
};

// As intersect_triangle sees it.
inline bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a) != glm::dvec3(0.0);
}

struct TriangleAnswers {
    using Numbers = std::array<float, kDoublesAtOnce>;
    HWY_ALIGN Numbers t, u, v;
    std::uint32_t hit = 0;    // as a mask
    std::uint32_t front = 0;  // the same

    // At a t between the two.
    [[nodiscard]] bool hits(std::size_t lane, float t_min, float t_max) const {
        return ((hit >> lane) & 1) != 0 && t[lane] > t_min && t[lane] < t_max;
    }
    [[nodiscard]] bool hits_front(std::size_t lane) const { return ((front >> lane) & 1) != 0; }
};

HWY_INLINE DoubleVector symmetric_sum(DoubleVector a, DoubleVector b, DoubleVector c) {
    const auto lower = smaller(a, b);
    const auto higher = larger(a, b);
    const auto middle = smaller(higher, c);
    const auto highest = larger(higher, c);
    return hn::Add(hn::Add(smaller(lower, middle), highest), larger(lower, middle));
}

// For triangles with an area only: those of none are not recognised here.
HWY_INLINE void decide(TriangleColumns columns, TriangleAnswers& answers) {
    const Doubles d;
    const Shear shear(columns.direction);
    for (auto& corner : columns.corner) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            corner[axis] = hn::Sub(corner[axis], columns.origin[axis]);
    }
    const auto az = shear.axes.z_of(columns.corner[0]);
    const auto bz = shear.axes.z_of(columns.corner[1]);
    const auto cz = shear.axes.z_of(columns.corner[2]);
    const auto ax = shear.across_x(columns.corner[0], az);
    const auto ay = shear.across_y(columns.corner[0], az);
    const auto bx = shear.across_x(columns.corner[1], bz);
    const auto by = shear.across_y(columns.corner[1], bz);
    const auto cx = shear.across_x(columns.corner[2], cz);
    const auto cy = shear.across_y(columns.corner[2], cz);
    const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
    const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
    const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
    const auto zero = hn::Zero(d);
    const auto positive = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero));
    const auto negative = hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero));
    const auto determinant = symmetric_sum(u, v, w);
    const auto hit = hn::And(hn::Or(positive, negative), hn::Gt(hn::Abs(determinant), zero));
    const auto scaled = symmetric_sum(hn::Mul(u, az), hn::Mul(v, bz), hn::Mul(w, cz));
    const auto inverse = hn::Div(hn::Set(d, 1.0), hn::Mul(determinant, shear.z));
    const hn::Rebind<float, Doubles> of_float;
    const auto store = [&](const DoubleVector& from, TriangleAnswers::Numbers& to) HWY_ATTR {
        hn::Store(hn::DemoteTo(of_float, from), of_float, to.data());
    };
    const auto per_weight = hn::Mul(shear.z, inverse);
    store(hn::Mul(scaled, inverse), answers.t);
    store(hn::Mul(v, per_weight), answers.u);
    store(hn::Mul(w, per_weight), answers.v);
    answers.hit = bits_of_mask(d, hit);
    answers.front = bits_of_mask(d, hn::Gt(determinant, zero));
}

// Decides the mask's rays, each with a triangle that set(ray, pairs, lane) puts into a lane; false:
// it has none. settle(ray, answers, lane) is told of those that have.
template <typename Set, typename Settle>
void decide_rays(std::uint64_t mask, const Set& set, const Settle& settle) {
    TrianglePairs pairs;
    TriangleAnswers answers;
    std::array<std::size_t, kDoublesAtOnce> rays{};
    while (mask != 0) {
        std::size_t count = 0;
        for (; mask != 0 && count < kDoublesAtOnce; mask &= mask - 1) {
            rays[count] = static_cast<std::size_t>(std::countr_zero(mask));
            if (set(rays[count], pairs, count)) ++count;
        }
        if (count == 0) return;
        pairs.fill_from(count);
        decide(TriangleColumns(pairs), answers);
        for (std::size_t lane = 0; lane < count; ++lane)
            settle(rays[lane], answers, lane);
    }
}

// The mask's rays with one triangle in their space.
template <typename Settle>
void decide_alike(const GroupRays& rays, RayMask mask, const TriangleCorners& corners,
                  const Settle& settle) {
    constexpr RayMask kSome = (RayMask{1} << kDoublesAtOnce) - 1;
    TriangleAnswers answers;
    while (mask != 0) {
        const auto first =
            static_cast<std::size_t>(std::countr_zero(mask)) / kDoublesAtOnce * kDoublesAtOnce;
        decide(TriangleColumns(rays, first, corners), answers);
        for (RayMask some = mask & (kSome << first); some != 0; some &= some - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(some));
            settle(ray, answers, ray - first);
        }
        mask &= ~(kSome << first);
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
