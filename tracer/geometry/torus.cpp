// The ring torus. Its quartic only says where to look: between the zeros of its derivative there is
// at most one root each, and whether there is one, and where, is decided by the distance to the
// tube, which keeps its precision where the quartic's coefficients cancel.
#include "tracer/geometry/axis_frame.h"
#include "tracer/geometry/shapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

// How much farther than the torus reaches it is looked for, so that both ends are surely outside.
constexpr double kMargin = 1.0 + 1e-9;

struct ValueAndSlope {
    double value = 0.0;
    double slope = 0.0;
};

// Ascending numbers: two ends and at most four roots.
struct Breaks {
    std::array<double, 6> at{};
    std::size_t count = 0;

    void push(double t) { at[count++] = t; }
};

// The root between two places where the function has different signs (positive and not positive):
// Newton's method, bisecting where it would leave the bracket or converges slowly. Source: Press et
// al., Numerical Recipes, 3rd ed. 2007, section 9.4.
template <typename Function>
double root_between(const Function& function, double not_positive, double positive) {
    constexpr int kMaxSteps = 120;
    double x = 0.5 * (not_positive + positive);
    double last_step = std::abs(positive - not_positive);
    for (int i = 0; i < kMaxSteps; ++i) {
        const ValueAndSlope f = function(x);
        (f.value > 0.0 ? positive : not_positive) = x;
        double next = x - f.value / f.slope;
        const bool inside = (next - not_positive) * (next - positive) < 0.0;
        // Written so that a NaN bisects.
        if (!(inside && std::abs(next - x) < 0.5 * last_step)) {
            next = 0.5 * (not_positive + positive);
        }
        last_step = std::abs(next - x);
        if (last_step <= 0x1p-53 * std::abs(x) || next == not_positive || next == positive) {
            return next;
        }
        x = next;
    }
    return x;
}

// A ray in the torus's frame, in units of its major radius: unit direction, starting nearest to the
// centre.
struct TorusRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    double start = 0.0;  // t of the original ray at `origin`
    double unit = 1.0;   // of the original ray's t in one unit of this one's
};

TorusRay torus_ray(const Torus& torus, const AxisFrame& frame, const ObjectRay& ray) {
    const double length = glm::length(ray.direction);
    const glm::dvec3 direction = ray.direction / length;
    const glm::dvec3 from_centre = ray.origin - torus.centre;
    const double distance = -glm::dot(from_centre, direction);
    TorusRay result;
    result.origin = frame.from_object(from_centre + distance * direction) / torus.major_radius;
    result.direction = frame.from_object(direction);
    result.start = distance / length;
    result.unit = torus.major_radius / length;
    return result;
}

// The torus of major radius 1 along one ray.
class Tube {
public:
    Tube(const TorusRay& ray, double radius) : o_(ray.origin), d_(ray.direction), radius_(radius) {}

    // Squared distance from the tube's circle, less the tube's own; negative inside.
    [[nodiscard]] ValueAndSlope beyond(double t) const {
        const glm::dvec3 p = o_ + t * d_;
        const double from_axis = std::hypot(p.x, p.z);
        const double from_ring = from_axis - 1.0;
        ValueAndSlope f;
        f.value = from_ring * from_ring + p.y * p.y - radius_ * radius_;
        f.slope = 2.0 * (from_ring * (p.x * d_.x + p.z * d_.z) / from_axis + p.y * d_.y);
        return f;
    }

    // Beginning and end of the part of the ray where the torus can be; none if it passes by.
    [[nodiscard]] Breaks reach() const {
        const double far = (1.0 + radius_) * kMargin;
        const double squared = far * far - glm::dot(o_, o_);
        if (!(squared >= 0.0)) return {};
        double low = -std::sqrt(squared);
        double high = -low;
        const double height = radius_ * kMargin;
        if (d_.y != 0.0) {
            const double t0 = (-height - o_.y) / d_.y;
            const double t1 = (height - o_.y) / d_.y;
            low = std::max(low, std::min(t0, t1));
            high = std::min(high, std::max(t0, t1));
        } else if (!(std::abs(o_.y) <= height)) {
            return {};
        }
        if (!(low < high)) return {};
        Breaks ends;
        ends.push(low);
        ends.push(high);
        return ends;
    }

    // The zeros of the quartic's derivative between the ends, with the ends. The quartic is
    // (|p|^2 + 1 - r^2)^2 - 4 (p.x^2 + p.z^2).
    [[nodiscard]] Breaks turning_points(const Breaks& ends) const {
        const double b = glm::dot(o_, d_);  // 0 but for rounding
        const double k = glm::dot(o_, o_) + 1.0 - radius_ * radius_;
        const double a = d_.x * d_.x + d_.z * d_.z;
        const double e = o_.x * d_.x + o_.z * d_.z;
        const std::array<double, 4> cubic{4.0 * b * k - 8.0 * e, 8.0 * b * b + 4.0 * k - 8.0 * a,
                                          12.0 * b, 4.0};
        const auto slope = [&cubic](double t) {
            return ValueAndSlope{
                cubic[0] + t * (cubic[1] + t * (cubic[2] + t * cubic[3])),
                cubic[1] + t * (2.0 * cubic[2] + t * 3.0 * cubic[3]),
            };
        };
        return zeros_between(slope, inflections(cubic, ends));
    }

    // The ends with the sign changes of `function` between consecutive breaks.
    template <typename Function>
    static Breaks zeros_between(const Function& function, const Breaks& breaks) {
        Breaks zeros;
        zeros.push(breaks.at[0]);
        for (std::size_t i = 1; i < breaks.count; ++i) {
            const double low = breaks.at[i - 1];
            const double high = breaks.at[i];
            const bool low_positive = function(low).value > 0.0;
            if (low_positive == (function(high).value > 0.0)) continue;
            zeros.push(low_positive ? root_between(function, high, low)
                                    : root_between(function, low, high));
        }
        zeros.push(breaks.at[breaks.count - 1]);
        return zeros;
    }

private:
    // The ends, and between them where the cubic's own derivative is 0.
    static Breaks inflections(const std::array<double, 4>& cubic, const Breaks& ends) {
        Breaks breaks;
        breaks.push(ends.at[0]);
        const double middle = -cubic[2] / (3.0 * cubic[3]);
        const double squared = middle * middle - cubic[1] / (3.0 * cubic[3]);
        if (squared > 0.0) {
            const double root = std::sqrt(squared);
            for (const double t : {middle - root, middle + root}) {
                if (t > ends.at[0] && t < ends.at[1]) breaks.push(t);
            }
        }
        breaks.push(ends.at[1]);
        return breaks;
    }

    glm::dvec3 o_;
    glm::dvec3 d_;
    double radius_;
};

ShapeHit torus_hit(const AxisFrame& frame, const TorusRay& ray, double t) {
    const glm::dvec3 p = ray.origin + t * ray.direction;
    const double from_axis = std::hypot(p.x, p.z);
    const double inwards = from_axis > 0.0 ? 1.0 / from_axis : 0.0;
    const glm::dvec3 ring{p.x * inwards, 0.0, p.z * inwards};
    ShapeHit hit;
    hit.t = ray.start + t * ray.unit;
    hit.normal = frame.to_object(p - ring);
    hit.uv = {turn(p.x, p.z), turn(from_axis - 1.0, p.y)};
    return hit;
}

}  // namespace

ShapeHits intersect(const Torus& torus, const ObjectRay& ray) {
    const AxisFrame frame = axis_frame(torus.axis);
    const TorusRay local = torus_ray(torus, frame, ray);
    const Tube tube(local, torus.minor_radius / torus.major_radius);
    const Breaks ends = tube.reach();
    if (ends.count == 0) return {};
    const Breaks pieces = tube.turning_points(ends);
    const Breaks roots = Tube::zeros_between([&tube](double t) { return tube.beyond(t); }, pieces);
    ShapeHits hits;
    for (std::size_t i = 1; i + 1 < roots.count; ++i) {
        hits.hit[static_cast<std::size_t>(hits.count++)] = torus_hit(frame, local, roots.at[i]);
    }
    return hits;
}

}  // namespace raypick
