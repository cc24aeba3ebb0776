// Cones against rays, lane by lane, in float with bounds on the rounding errors: surely hit, surely
// missed, or left to cone_roots. Included once for each instruction set.
#if defined(RAYPICK_CONE_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYPICK_CONE_BOUNDS_INL_H
#undef RAYPICK_CONE_BOUNDS_INL_H
#else
#define RAYPICK_CONE_BOUNDS_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Where a ray meets a cone is estimated, and then made sure of at single points of the ray, so that
// nothing depends on how good the estimate is. Both the side, where F = |across| - radius(height)
// <= 0, and the slab between the planes hold one interval of the ray each, as F is convex along it:
// - A point outside of the side before which F falls has no point of the side before it, and one
//   after which F rises none after it; the same of planes, t_min and t_far. If for some t one of
//   these rules out what comes before and another what comes after, the ray misses.
// - If it is outside of the side at one t, inside at another, and between the planes at both, then
//   it crosses the side between the two.
//
// In float (u = 2^-24), with components of the axis and a widening wrong by 7 u of themselves, as
// they are where float worked them out, and with components of the offset f of a ray's origin from
// the base of at most R and of the direction of at most D: f . axis is wrong by less than 20 u R,
// the components across the axis by 36 u R, those of the direction likewise with D, and so heights
// and the components of `across` at t by less than `place` = 40 u (R + |t| D); F by
// (2 + |widening|) place + 8 u widest, and its slope (times |across|) by
// D (1 + |widening|) (4 place + 80 u |across|). The double code is wrong by a small part of that.
template <class V>
struct ConeLanes {
    V base_x, base_y, base_z;
    V axis_x, axis_y, axis_z;
    V length;
    V radius;    // at the base
    V widening;  // of the radius, per height
    V widest;
    V rounding;  // of the origin: the largest coordinate it was rounded from, or 0
};

// Cones by their ends.
template <class D, class V = hn::Vec<D>>
HWY_INLINE ConeLanes<V> cone_lanes(D d, V base_x, V base_y, V base_z, V radius, V apex_x, V apex_y,
                                   V apex_z, V at_apex, V rounding) {
    const V x = hn::Sub(apex_x, base_x);
    const V y = hn::Sub(apex_y, base_y);
    const V z = hn::Sub(apex_z, base_z);
    const V squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    // Squares of less underflow: then comparisons with NaN rule nothing out.
    const auto fits = hn::Gt(squared, hn::Set(d, 0x1p-80f));
    const V nothing = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    const V length = hn::IfThenElse(fits, hn::Sqrt(squared), nothing);
    const V by_length = hn::Div(hn::Set(d, 1.0f), length);
    return {base_x,
            base_y,
            base_z,
            hn::Mul(x, by_length),
            hn::Mul(y, by_length),
            hn::Mul(z, by_length),
            length,
            radius,
            hn::Mul(hn::Sub(at_apex, radius), by_length),
            hn::Max(radius, at_apex),
            rounding};
}

template <class V>
struct RayLanes {
    V origin_x, origin_y, origin_z;
    V direction_x, direction_y, direction_z;
    V steepest;  // the largest component of the direction, or more
    V t_min, t_far;
};

template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
class ConeBounds {
public:
    HWY_INLINE ConeBounds(const ConeLanes<V>& cone, const RayLanes<V>& ray)
        : cone_(cone),
          ray_(ray),
          f_x_(hn::Sub(ray.origin_x, cone.base_x)),
          f_y_(hn::Sub(ray.origin_y, cone.base_y)),
          f_z_(hn::Sub(ray.origin_z, cone.base_z)),
          reach_(hn::Add(hn::Max(hn::Max(hn::Abs(f_x_), hn::Abs(f_y_)), hn::Abs(f_z_)),
                         cone.rounding)),
          height_(along_axis(f_x_, f_y_, f_z_)),
          climb_(along_axis(ray.direction_x, ray.direction_y, ray.direction_z)),
          across_x_(hn::NegMulAdd(height_, cone.axis_x, f_x_)),
          across_y_(hn::NegMulAdd(height_, cone.axis_y, f_y_)),
          across_z_(hn::NegMulAdd(height_, cone.axis_z, f_z_)),
          drift_x_(hn::NegMulAdd(climb_, cone.axis_x, ray.direction_x)),
          drift_y_(hn::NegMulAdd(climb_, cone.axis_y, ray.direction_y)),
          drift_z_(hn::NegMulAdd(climb_, cone.axis_z, ray.direction_z)),
          squared_drift_(dot(drift_x_, drift_y_, drift_z_, drift_x_, drift_y_, drift_z_)),
          gap_(gap()) {}

    // The ray's line passes the axis farther off than the cone is wide. |drift| is wrong by less
    // than 64 u D.
    HWY_INLINE M passes_by() const {
        const V error =
            hn::MulAdd(hn::Set(D(), 64.0f * kUnit),
                       hn::Mul(ray_.steepest, hn::Add(reach_, cone_.widest)), hn::Set(D(), kTiny));
        const V least = hn::Sub(gap_, error);
        const V squared = hn::Mul(hn::Mul(cone_.widest, cone_.widest), squared_drift_);
        return hn::And(hn::Gt(least, hn::Zero(D())),
                       hn::Gt(hn::Mul(least, least),
                              hn::MulAdd(squared, hn::Set(D(), kMore), hn::Set(D(), kTiny))));
    }

    // Works out about where the ray meets the planes and the side.
    HWY_INLINE void estimate() {
        const V one_by_climb = hn::Div(hn::Set(D(), 1.0f), climb_);
        const V at_base = hn::Neg(hn::Mul(height_, one_by_climb));
        const V at_apex = hn::Mul(hn::Sub(cone_.length, height_), one_by_climb);
        slab_from_ = hn::Min(at_base, at_apex);
        slab_to_ = hn::Max(at_base, at_apex);
        const V drift = dot(across_x_, across_y_, across_z_, drift_x_, drift_y_, drift_z_);
        const V one_by_squared = hn::Div(hn::Set(D(), 1.0f), squared_drift_);
        const V nearest = hn::Neg(hn::Mul(drift, one_by_squared));
        const V height = hn::MulAdd(nearest, climb_, height_);
        const V radius = hn::MulAdd(cone_.widening, height, cone_.radius);
        const V growth = hn::Mul(cone_.widening, climb_);
        const V squared_growth = hn::Mul(growth, growth);
        const V squared_gap = hn::Mul(gap_, gap_);
        // a s^2 - 2 radius growth s - (radius^2 - distance^2) = 0, s counted from `nearest`
        const V a = hn::Sub(squared_drift_, squared_growth);
        const V discriminant =
            hn::Sub(hn::MulAdd(hn::Mul(squared_gap, one_by_squared), squared_growth,
                               hn::Mul(squared_drift_, hn::Mul(radius, radius))),
                    squared_gap);
        root_ = hn::Sqrt(hn::Max(discriminant, hn::Zero(D())));
        const V one_by_a = hn::Div(hn::Set(D(), 1.0f), a);
        const V middle = hn::Mul(radius, growth);
        side_from_ = hn::MulAdd(hn::Sub(middle, root_), one_by_a, nearest);
        side_to_ = hn::MulAdd(hn::Add(middle, root_), one_by_a, nearest);
        ordinary_ = hn::Gt(a, hn::Zero(D()));  // not steeper than the side
    }

    // After estimate(): nothing of the body lies between t_min and t_far.
    HWY_INLINE M misses() const {
        const V from = hn::Max(hn::Max(slab_from_, side_from_), ray_.t_min);
        const V to = hn::Min(hn::Min(slab_to_, side_to_), ray_.t_far);
        const V t = hn::Mul(hn::Add(from, to), hn::Set(D(), 0.5f));
        const Point p = point(t);
        const V slope = hn::Sub(dot(p.x, p.y, p.z, drift_x_, drift_y_, drift_z_),
                                hn::Mul(hn::Mul(cone_.widening, climb_), p.distance));
        const V slope_error =
            hn::MulAdd(hn::Mul(ray_.steepest, hn::Add(hn::Abs(cone_.widening), hn::Set(D(), 1.0f))),
                       hn::MulAdd(p.place_error, hn::Set(D(), 4.0f),
                                  hn::Mul(p.distance, hn::Set(D(), 80.0f * kUnit))),
                       hn::Set(D(), kTiny));
        const M out = outside(p);
        const M under = hn::Lt(p.height, hn::Neg(p.place_error));
        const M over = hn::Gt(p.height, top(p));
        const V climb_error = climb_error_bound();
        const M up = hn::Gt(climb_, climb_error);
        const M down = hn::Lt(climb_, hn::Neg(climb_error));
        // What the double code may be wrong by: the direction is not shorter than 2^-20.
        const V blur = hn::Mul(reach_, hn::Set(D(), 0x1p-24f));
        const M none_before =
            hn::Or(hn::Or(hn::And(out, hn::Lt(slope, hn::Neg(slope_error))),
                          hn::Lt(hn::Add(t, blur), hn::Mul(ray_.t_min, hn::Set(D(), kLess)))),
                   hn::Or(hn::And(under, up), hn::And(over, down)));
        const M none_after =
            hn::Or(hn::Or(hn::And(out, hn::Gt(slope, slope_error)),
                          hn::Gt(hn::Sub(t, blur), hn::Mul(ray_.t_far, hn::Set(D(), kMore)))),
                   hn::Or(hn::And(under, down), hn::And(over, up)));
        // Rays that need no more hits have a t_far before t_min.
        return hn::Or(hn::And(none_before, none_after), hn::Lt(ray_.t_far, ray_.t_min));
    }

    // After estimate(): the first hit that counts, on the side, surely lies between these.
    struct Crossing {
        M sure;
        V from, to;
    };
    HWY_INLINE Crossing crossing(bool front, bool back, bool capped) const {
        const V zero = hn::Zero(D());
        const M never = hn::Lt(zero, zero);
        const M enters =
            front ? hn::And(hn::Gt(side_from_, slab_from_), hn::Gt(side_from_, ray_.t_min)) : never;
        const V at = hn::IfThenElse(enters, side_from_, side_to_);
        const V error = side_error(place_error(at));
        const V width = hn::Div(hn::Mul(hn::Add(error, error), cone_.widest), root_);
        Crossing result;
        result.from = hn::Sub(at, width);
        result.to = hn::Add(at, width);
        const Point outer = point(hn::IfThenElse(enters, result.from, result.to));
        const Point inner = point(hn::IfThenElse(enters, result.to, result.from));
        result.from = hn::Mul(result.from, hn::Set(D(), kLess));
        result.to = hn::Mul(result.to, hn::Set(D(), kMore));
        M sure = hn::And(hn::And(outside(outer), inside(inner)),
                         hn::And(between(outer), between(inner)));
        sure =
            hn::And(sure, hn::And(hn::Gt(result.from, ray_.t_min), hn::Lt(result.to, ray_.t_far)));
        sure = hn::And(sure, ordinary_);
        const M leaves = hn::AndNot(enters, sure);
        if (!back) {
            sure = hn::And(sure, enters);
        } else if (front && !hn::AllFalse(D(), leaves)) {
            sure = hn::Or(hn::And(sure, enters), hn::And(leaves, comes_uncounted(capped)));
        }
        result.sure = sure;
        return result;
    }

private:
    static constexpr float kUnit = 0x1p-24f;
    static constexpr float kTiny = 16.0f * std::numeric_limits<float>::min();
    static constexpr float kMore = 1.0f + 8.0f * kUnit;
    static constexpr float kLess = 1.0f - 8.0f * kUnit;

    struct Point {
        V t;
        V x, y, z;  // from the axis
        V squared_distance, distance;
        V height;
        V radius;  // of the cone there
        V place_error;
    };

    static HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
        return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
    }
    HWY_INLINE V along_axis(V x, V y, V z) const {
        return dot(x, y, z, cone_.axis_x, cone_.axis_y, cone_.axis_z);
    }
    // d . (axis x f): each component of the cross product is wrong by 16 u R, the whole by less
    // than 60 u R D.
    HWY_INLINE V gap() const {
        const V x = hn::NegMulAdd(cone_.axis_z, f_y_, hn::Mul(cone_.axis_y, f_z_));
        const V y = hn::NegMulAdd(cone_.axis_x, f_z_, hn::Mul(cone_.axis_z, f_x_));
        const V z = hn::NegMulAdd(cone_.axis_y, f_x_, hn::Mul(cone_.axis_x, f_y_));
        return hn::Abs(dot(ray_.direction_x, ray_.direction_y, ray_.direction_z, x, y, z));
    }
    HWY_INLINE V climb_error_bound() const {
        return hn::Mul(ray_.steepest, hn::Set(D(), 20.0f * kUnit));
    }
    HWY_INLINE V place_error(V t) const {
        return hn::MulAdd(hn::MulAdd(hn::Abs(t), ray_.steepest, reach_),
                          hn::Set(D(), 40.0f * kUnit), hn::Set(D(), kTiny));
    }
    HWY_INLINE V side_error(V place) const {
        return hn::MulAdd(hn::Add(hn::Abs(cone_.widening), hn::Set(D(), 2.0f)), place,
                          hn::Mul(cone_.widest, hn::Set(D(), 8.0f * kUnit)));
    }
    HWY_INLINE Point point(V t) const {
        Point p;
        p.t = t;
        p.x = hn::MulAdd(t, drift_x_, across_x_);
        p.y = hn::MulAdd(t, drift_y_, across_y_);
        p.z = hn::MulAdd(t, drift_z_, across_z_);
        p.squared_distance = dot(p.x, p.y, p.z, p.x, p.y, p.z);
        p.distance = hn::Sqrt(p.squared_distance);
        p.height = hn::MulAdd(t, climb_, height_);
        p.radius = hn::MulAdd(cone_.widening, p.height, cone_.radius);
        p.place_error = place_error(t);
        return p;
    }
    // Arranged, as all of these, so that a NaN makes nothing sure.
    HWY_INLINE M outside(const Point& p) const {
        return hn::Gt(hn::Mul(p.distance, hn::Set(D(), kLess)),
                      hn::Add(hn::Add(p.radius, side_error(p.place_error)), hn::Set(D(), kBlur)));
    }
    HWY_INLINE M inside(const Point& p) const {
        return hn::Lt(hn::Add(hn::Mul(p.distance, hn::Set(D(), kMore)), hn::Set(D(), kBlur)),
                      hn::Sub(p.radius, side_error(p.place_error)));
    }
    HWY_INLINE V top(const Point& p) const {
        return hn::MulAdd(cone_.length, hn::Set(D(), kMore), p.place_error);
    }
    HWY_INLINE M between(const Point& p) const {
        return hn::And(hn::Gt(p.height, p.place_error),
                       hn::Lt(p.height, hn::MulAdd(cone_.length, hn::Set(D(), kLess),
                                                   hn::Neg(p.place_error))));
    }
    // The ray is inside before t_min, or comes in through an open end.
    HWY_INLINE M comes_uncounted(bool capped) const {
        const V step =
            hn::Div(hn::Mul(place_error(slab_from_), hn::Set(D(), 2.0f)), hn::Abs(climb_));
        const V before = hn::Sub(slab_from_, step);
        const M through = capped ? hn::Lt(step, hn::Zero(D())) : hn::Gt(before, ray_.t_min);
        const Point p = point(hn::IfThenElse(through, before, ray_.t_min));
        const M beyond_end = hn::Or(
            hn::And(hn::Lt(p.height, hn::Neg(p.place_error)), hn::Gt(climb_, climb_error_bound())),
            hn::And(hn::Gt(p.height, top(p)), hn::Lt(climb_, hn::Neg(climb_error_bound()))));
        const M there = hn::Or(hn::And(through, beyond_end), hn::AndNot(through, between(p)));
        return hn::And(inside(p), there);
    }

    // Squares of less underflow, and roots of these are wrong by it.
    static constexpr float kBlur = 0x1p-60f;

    const ConeLanes<V>& cone_;
    const RayLanes<V>& ray_;
    V f_x_, f_y_, f_z_;
    V reach_;
    V height_, climb_;  // along the axis, at the origin and per t
    V across_x_, across_y_, across_z_;
    V drift_x_, drift_y_, drift_z_;
    V squared_drift_;
    V gap_;  // the distance of the two lines, times |drift|
    V slab_from_, slab_to_;
    V side_from_, side_to_;
    V root_;  // of the discriminant
    M ordinary_;
};

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
