#include "tracer/accel/shape_surfaces.h"

#include <variant>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/shape_surfaces.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "tracer/accel/simd/surface_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

namespace {

// Of std.
HWY_INLINE DoubleVector clamp(DoubleVector x, DoubleVector low, DoubleVector high) {
    return hn::IfThenElse(hn::Lt(x, low), low, smaller(x, high));
}

// Of the shapes, as of_ray.
class ShapeLanes : public SurfaceLanes {
public:
    HWY_INLINE ShapeLanes(const ShapeSurfaces::Inputs& in, SurfaceRows& rows, std::size_t i)
        : SurfaceLanes(rows, i), first_(&in.row[i]) {}

    HWY_INLINE DoubleVector of_shape(std::size_t row) const {
        return hn::LoadU(Doubles(), first_ + row * SurfaceRows::kLanes);
    }
    HWY_INLINE DoubleVector3 of_shape3(std::size_t first) const {
        return {of_shape(first), of_shape(first + 1), of_shape(first + 2)};
    }

    // `normal` is unit.
    HWY_INLINE void store(const DoubleVector3& position, DoubleVector magnitude,
                          const DoubleVector3& normal) const {
        store_position(position, magnitude);
        store3(SurfaceRows::kGeometric, normal);
        store3(SurfaceRows::kShading, normal);
    }

private:
    const double* first_;
};

// sphere_t of local_point.cpp. `f`: from the centre to the origin.
HWY_INLINE DoubleVector exact_t(const DoubleVector3& f, const DoubleVector3& direction,
                                DoubleVector radius, DoubleVector t) {
    const DoubleVector a = dot(direction, direction);
    const DoubleVector middle = hn::Div(hn::Neg(dot(f, direction)), a);
    const DoubleVector3 closest = plus(f, times(middle, direction));
    const DoubleVector squared =
        hn::Div(hn::Sub(hn::Mul(radius, radius), dot(closest, closest)), a);
    const DoubleVector half = hn::CopySign(hn::Sqrt(squared), hn::Sub(t, middle));
    return hn::IfThenElse(hn::Gt(squared, number(0.0)), hn::Add(middle, half), t);
}

HWY_INLINE void find_sphere(const ShapeLanes& lanes) {
    using In = ShapeSurfaces;
    const DoubleVector3 origin = lanes.of_ray3(SurfaceRows::kOrigin);
    const DoubleVector3 direction = lanes.of_ray3(SurfaceRows::kDirection);
    const DoubleVector3 centre = lanes.of_shape3(In::kCentre);
    const DoubleVector radius = lanes.of_shape(In::kRadius);
    const DoubleVector t =
        exact_t(minus(origin, centre), direction, radius, lanes.of_ray(SurfaceRows::kT));
    const DoubleVector3 n = normalize(minus(plus(origin, times(t, direction)), centre));
    lanes.store(plus(centre, times(radius, n)), hn::Add(largest(centre), radius), normalize(n));
}

// Rim::share of local_point.cpp, of the height over `edge`; `area`: of the piece.
HWY_INLINE DoubleVector rim_share(DoubleVector rim, DoubleVector area, const DoubleVector3& edge) {
    const DoubleVector height = hn::Div(area, length(edge));
    return hn::IfThenElse(hn::Gt(height, hn::Mul(number(4.0), rim)), hn::Div(rim, height),
                          number(0.25));
}

HWY_INLINE void find_rectangle(const ShapeLanes& lanes) {
    using In = ShapeSurfaces;
    const DoubleVector zero = number(0.0);
    const DoubleVector one = number(1.0);
    const DoubleVector3 origin = lanes.of_ray3(SurfaceRows::kOrigin);
    const DoubleVector3 direction = lanes.of_ray3(SurfaceRows::kDirection);
    const DoubleVector3 corner = lanes.of_shape3(In::kCorner);
    const DoubleVector3 u = lanes.of_shape3(In::kEdgeU);
    const DoubleVector3 v = lanes.of_shape3(In::kEdgeV);
    const DoubleVector3 normal = cross(u, v);

    // meet_within of flat_shapes.cpp.
    const DoubleVector t = hn::Div(dot(normal, minus(corner, origin)), dot(normal, direction));
    const DoubleVector3 from_corner = plus(minus(origin, corner), times(t, direction));
    const DoubleVector squared_area = dot(normal, normal);
    const auto share = [&](const DoubleVector3& area) HWY_ATTR {
        const DoubleVector whole = hn::Div(dot(area, normal), squared_area);
        return hn::IfThenElseZero(hn::IsFinite(t), clamp(whole, zero, one));
    };

    const DoubleVector away =
        largest(plus(origin, times(lanes.of_ray(SurfaceRows::kT), direction)));
    const DoubleVector rim = rim_at(away);
    const DoubleVector area = hn::Sqrt(squared_area);
    const auto within = [&](DoubleVector at, DoubleVector margin)
                            HWY_ATTR { return clamp(at, margin, hn::Sub(one, margin)); };
    const DoubleVector at_u = within(share(cross(from_corner, v)), rim_share(rim, area, v));
    const DoubleVector at_v = within(share(cross(u, from_corner)), rim_share(rim, area, u));
    lanes.store(plus(plus(corner, times(at_u, u)), times(at_v, v)),
                hn::Add(hn::Add(largest(corner), largest(u)), largest(v)), normalize(normal));
}

}  // namespace

void find_spheres(const ShapeSurfaces::Inputs& in, SurfaceRows& rows) {
    for (std::size_t i = 0; i < rows.count; i += hn::Lanes(Doubles()))
        find_sphere(ShapeLanes(in, rows, i));
}

void find_rectangles(const ShapeSurfaces::Inputs& in, SurfaceRows& rows) {
    for (std::size_t i = 0; i < rows.count; i += hn::Lanes(Doubles()))
        find_rectangle(ShapeLanes(in, rows, i));
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raypick {

HWY_EXPORT(find_spheres);
HWY_EXPORT(find_rectangles);

ShapeSurfaces::Kind ShapeSurfaces::kind(const HitObject& at) {
    const Shape& shape = at.object.shape;
    if (at.textured || !at.object_from_world.is_identity()) return Kind::other;
    if (std::holds_alternative<Rectangle>(shape)) return Kind::rectangle;
    const bool spheres =
        std::holds_alternative<SphereSetInstance>(shape) || std::holds_alternative<Sphere>(shape);
    return spheres ? Kind::sphere : Kind::other;
}

void ShapeSurfaces::add(std::size_t lane, const Scene& scene, const Shape& shape,
                        std::uint32_t primitive) {
    double* const in = &in_.row[lane];
    const auto put = [in](std::size_t row, const glm::dvec3& v) { put_vector<kLanes>(in, row, v); };
    if (const auto* set = std::get_if<SphereSetInstance>(&shape)) {
        const glm::vec4& sphere = scene.sphere_sets[set->set].spheres[primitive];
        put(kCentre, glm::dvec3(sphere));
        in[kRadius * kLanes] = static_cast<double>(sphere.w);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        put(kCentre, sphere->centre);
        in[kRadius * kLanes] = sphere->radius;
    } else {
        const auto& rectangle = std::get<Rectangle>(shape);
        put(kCorner, rectangle.corner);
        put(kEdgeU, rectangle.edge_u);
        put(kEdgeV, rectangle.edge_v);
    }
}

void ShapeSurfaces::find_spheres(SurfaceRows& rows) const {
    HWY_DYNAMIC_DISPATCH(find_spheres)(in_, rows);
}

void ShapeSurfaces::find_rectangles(SurfaceRows& rows) const {
    HWY_DYNAMIC_DISPATCH(find_rectangles)(in_, rows);
}

}  // namespace raypick

#endif  // HWY_ONCE
