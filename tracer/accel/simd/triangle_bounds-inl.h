// Edge functions of triangles and where rays meet their planes, lane by lane, in float with bounds
// on the rounding errors: see GroupTriangles. Included once for each instruction set.
#if defined(RAYPICK_TRIANGLE_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_TRIANGLE_BOUNDS_INL_H
#undef RAYPICK_TRIANGLE_BOUNDS_INL_H
#else
#define RAYPICK_TRIANGLE_BOUNDS_INL_H
#endif

#include "tracer/accel/hit.h"
#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/scene/scene.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct ShownSides {
    bool front = true;
    bool back = true;

    [[nodiscard]] bool any() const { return front || back; }
};

// Those of the object that count for the query.
inline ShownSides shown_sides(const Object& object, const RayQuery& query) {
    return {shows(object.sides, true) && shows(query.sides, true),
            shows(object.sides, false) && shows(query.sides, false)};
}

// Lanes are rays with one triangle, or triangles with one ray.
template <class V>
struct EdgeFunctions {
    V u, v, w;
    V slope;   // n . d
    V height;  // n . (a - o)
};

// n . (a - o) of the rays as they are, signed as the slope is, and its error: near a ray's own
// origin it is most exact.
template <class V>
struct Height {
    V value;
    V error;
};

// What the bounds make of the lanes' edge functions.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
class EdgeBounded {
public:
    HWY_INLINE EdgeBounded(const EdgeFunctions<V>& f, V error)
        : least_(hn::Min(hn::Min(f.u, f.v), f.w)),
          most_(hn::Max(hn::Max(f.u, f.v), f.w)),
          error_(error) {}

    // One of the functions surely is. Arranged so that a NaN rules nothing out.
    [[nodiscard]] HWY_INLINE M below() const { return hn::Lt(least_, hn::Neg(error_)); }
    [[nodiscard]] HWY_INLINE M above() const { return hn::Gt(most_, error_); }

    // A ray that meets the front goes against n.
    [[nodiscard]] HWY_INLINE M misses(const ShownSides& shown) const {
        if (!shown.back) return above();
        if (!shown.front) return below();
        return hn::And(below(), above());
    }
    [[nodiscard]] HWY_INLINE M surely_within() const {
        return hn::Or(hn::Gt(least_, error_), hn::Lt(most_, hn::Neg(error_)));
    }

private:
    V least_, most_;
    V error_;
};

// Where the lanes' rays meet the planes of the triangles.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
class PlaneBounded {
public:
    HWY_INLINE PlaneBounded(V slope, V slope_error, const Height<V>& height)
        : slope_(hn::Abs(slope)),
          slope_error_(slope_error),
          height_(hn::Xor(height.value, hn::And(slope, hn::SignBit(D())))),
          height_error_(height.error),
          steep_(hn::Add(slope_, slope_error)),
          flat_(hn::Sub(slope_, slope_error)) {}

    // Outside of this interval, or there is no such.
    [[nodiscard]] HWY_INLINE M misses(V t_min, V t_far) const {
        const auto beyond = hn::Or(
            hn::Lt(t_far, t_min),
            hn::Gt(hn::Sub(height_, height_error_), hn::Mul(hn::Mul(t_far, grow()), steep_)));
        const auto before = hn::And(
            hn::Gt(flat_, hn::Zero(D())),
            hn::Lt(hn::Add(height_, height_error_), hn::Mul(hn::Mul(t_min, shrink()), flat_)));
        return hn::Or(beyond, before);
    }
    [[nodiscard]] HWY_INLINE V from() const {
        return hn::Mul(hn::Div(hn::Sub(height_, height_error_), steep_), shrink());
    }
    [[nodiscard]] HWY_INLINE V to() const {
        return hn::Mul(hn::Div(hn::Add(height_, height_error_), flat_), grow());
    }
    // The t between from() and to().
    [[nodiscard]] HWY_INLINE M surely_within(V from, V to, V t_min, V t_far) const {
        const auto steep = hn::Gt(slope_, hn::Mul(slope_error_, hn::Set(D(), 8.0f)));
        return hn::And(steep, hn::And(hn::Gt(from, t_min), hn::Lt(to, t_far)));
    }

private:
    static HWY_INLINE V grow() { return hn::Set(D(), kGrowGroup); }
    static HWY_INLINE V shrink() { return hn::Set(D(), kShrinkGroup); }

    V slope_, slope_error_;
    V height_, height_error_;
    V steep_, flat_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
