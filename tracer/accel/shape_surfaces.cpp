#include "tracer/accel/shape_surfaces.h"

#include "tracer/accel/lane_rows.h"

#include <limits>
#include <span>
#include <variant>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/shape_surfaces.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "tracer/accel/simd/double_vectors-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

namespace {

// The steps are those of surface.cpp and local_point.cpp one by one, in double, so that no bit
// differs.
HWY_INLINE DoubleVector number(double x) {
    return hn::Set(Doubles(), x);
}
HWY_INLINE DoubleVector largest(const DoubleVector3& a) {
    const DoubleVector3 s = size(a);
    return larger(larger(s.x, s.y), s.z);
}
// Of std.
HWY_INLINE DoubleVector clamp(DoubleVector x, DoubleVector low, DoubleVector high) {
    return hn::IfThenElse(hn::Lt(x, low), low, smaller(x, high));
}

// As many hits of a block as a vector holds, from lane i on.
class Lanes {
public:
    using In = ShapeSurfaces;

    HWY_INLINE Lanes(ShapeSurfaces::Block& block, std::size_t i) : block_(block), i_(i) {}

    HWY_INLINE DoubleVector load(std::size_t row) const {
        return hn::LoadU(Doubles(), &block_.in[row * ShapeSurfaces::kLanes + i_]);
    }
    HWY_INLINE DoubleVector3 load3(std::size_t first) const {
        return {load(first), load(first + 1), load(first + 2)};
    }

    // `magnitude` as in LocalPoint; `normal` is unit.
    HWY_INLINE void store(const DoubleVector3& position, DoubleVector magnitude,
                          const DoubleVector3& normal) const {
        const DoubleVector3 reach = size(position);
        const auto bound = [&](DoubleVector along) HWY_ATTR {
            return hn::Add(hn::Mul(along, number(0x1p-24)),
                           hn::Mul(hn::Add(along, magnitude), number(0x1p-47)));
        };
        store3(In::kPosition, position, -0.0f);
        store3(In::kError, {bound(reach.x), bound(reach.y), bound(reach.z)},
               std::numeric_limits<float>::min());
        store3(In::kNormal, normal, -0.0f);
    }

private:
    HWY_INLINE void store3(std::size_t first, const DoubleVector3& a, float more) const {
        const hn::Rebind<float, Doubles> f;
        const auto put = [&](std::size_t row, DoubleVector v) HWY_ATTR {
            hn::StoreU(hn::Add(hn::DemoteTo(f, v), hn::Set(f, more)), f,
                       &block_.out[row * ShapeSurfaces::kLanes + i_]);
        };
        put(first, a.x);
        put(first + 1, a.y);
        put(first + 2, a.z);
    }

    ShapeSurfaces::Block& block_;
    std::size_t i_;
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

HWY_INLINE void find_sphere(const Lanes& lanes) {
    using In = ShapeSurfaces;
    const DoubleVector3 origin = lanes.load3(In::kOrigin);
    const DoubleVector3 direction = lanes.load3(In::kDirection);
    const DoubleVector3 centre = lanes.load3(In::kCentre);
    const DoubleVector radius = lanes.load(In::kRadius);
    const DoubleVector t = exact_t(minus(origin, centre), direction, radius, lanes.load(In::kT));
    const DoubleVector3 n = normalize(minus(plus(origin, times(t, direction)), centre));
    lanes.store(plus(centre, times(radius, n)), hn::Add(largest(centre), radius), normalize(n));
}

// Rim::share of local_point.cpp, of the height over `edge`; `area`: of the piece.
HWY_INLINE DoubleVector rim_share(DoubleVector rim, DoubleVector area, const DoubleVector3& edge) {
    const DoubleVector height = hn::Div(area, length(edge));
    return hn::IfThenElse(hn::Gt(height, hn::Mul(number(4.0), rim)), hn::Div(rim, height),
                          number(0.25));
}

HWY_INLINE void find_rectangle(const Lanes& lanes) {
    using In = ShapeSurfaces;
    const DoubleVector zero = number(0.0);
    const DoubleVector one = number(1.0);
    const DoubleVector3 origin = lanes.load3(In::kOrigin);
    const DoubleVector3 direction = lanes.load3(In::kDirection);
    const DoubleVector3 corner = lanes.load3(In::kCorner);
    const DoubleVector3 u = lanes.load3(In::kEdgeU);
    const DoubleVector3 v = lanes.load3(In::kEdgeV);
    const DoubleVector3 normal = cross(u, v);

    // meet_within of flat_shapes.cpp.
    const DoubleVector t = hn::Div(dot(normal, minus(corner, origin)), dot(normal, direction));
    const DoubleVector3 from_corner = plus(minus(origin, corner), times(t, direction));
    const DoubleVector squared_area = dot(normal, normal);
    const auto share = [&](const DoubleVector3& area) HWY_ATTR {
        const DoubleVector whole = hn::Div(dot(area, normal), squared_area);
        return hn::IfThenElseZero(hn::IsFinite(t), clamp(whole, zero, one));
    };

    const DoubleVector away = largest(plus(origin, times(lanes.load(In::kT), direction)));
    const DoubleVector rim = hn::Mul(
        number(64.0), hn::Add(hn::Mul(away, number(0x1p-24)), hn::Mul(away, number(0x1p-47))));
    const DoubleVector area = hn::Sqrt(squared_area);
    const auto within = [&](DoubleVector at, DoubleVector margin)
                            HWY_ATTR { return clamp(at, margin, hn::Sub(one, margin)); };
    const DoubleVector at_u = within(share(cross(from_corner, v)), rim_share(rim, area, v));
    const DoubleVector at_v = within(share(cross(u, from_corner)), rim_share(rim, area, u));
    lanes.store(plus(plus(corner, times(at_u, u)), times(at_v, v)),
                hn::Add(hn::Add(largest(corner), largest(u)), largest(v)), normalize(normal));
}

}  // namespace

void find_spheres(std::span<ShapeSurfaces::Block> blocks) {
    for (ShapeSurfaces::Block& block : blocks) {
        for (std::size_t i = 0; i < ShapeSurfaces::kLanes; i += hn::Lanes(Doubles()))
            find_sphere(Lanes(block, i));
    }
}

void find_rectangles(std::span<ShapeSurfaces::Block> blocks) {
    for (ShapeSurfaces::Block& block : blocks) {
        for (std::size_t i = 0; i < ShapeSurfaces::kLanes; i += hn::Lanes(Doubles()))
            find_rectangle(Lanes(block, i));
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raypick {

HWY_EXPORT(find_spheres);
HWY_EXPORT(find_rectangles);

namespace {

// Of the blocks that hold `count` hits.
std::span<ShapeSurfaces::Block> used(std::vector<ShapeSurfaces::Block>& blocks, std::size_t count) {
    return std::span(blocks).first((count + ShapeSurfaces::kLanes - 1) / ShapeSurfaces::kLanes);
}

void put(double* in, std::size_t row, const glm::dvec3& v) {
    put_vector<ShapeSurfaces::kLanes>(in, row, v);
}

void put_shape(double* in, const Scene& scene, const Shape& shape, std::uint32_t primitive) {
    using In = ShapeSurfaces;
    if (const auto* set = std::get_if<SphereSetInstance>(&shape)) {
        const glm::vec4& sphere = scene.sphere_sets[set->set].spheres[primitive];
        put(in, In::kCentre, glm::dvec3(sphere));
        in[In::kRadius * In::kLanes] = static_cast<double>(sphere.w);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        put(in, In::kCentre, sphere->centre);
        in[In::kRadius * In::kLanes] = sphere->radius;
    } else {
        const auto& rectangle = std::get<Rectangle>(shape);
        put(in, In::kCorner, rectangle.corner);
        put(in, In::kEdgeU, rectangle.edge_u);
        put(in, In::kEdgeV, rectangle.edge_v);
    }
}

}  // namespace

ShapeSurfaces::Kind ShapeSurfaces::kind(const HitObject& at) {
    const Shape& shape = at.object.shape;
    if (at.textured || !at.object_from_world.is_identity()) return Kind::other;
    if (std::holds_alternative<Rectangle>(shape)) return Kind::rectangle;
    const bool spheres =
        std::holds_alternative<SphereSetInstance>(shape) || std::holds_alternative<Sphere>(shape);
    return spheres ? Kind::sphere : Kind::other;
}

void ShapeSurfaces::add(Kind kind, const Scene& scene, const HitObject& at, const Ray& ray,
                        const Hit& hit, SurfacePoint& result) {
    Hits& hits = kind == Kind::sphere ? spheres_ : rectangles_;
    if (hits.count == hits.wanted.size()) {
        hits.blocks.resize(2 * hits.blocks.size() + 1);
        hits.wanted.resize(kLanes * hits.blocks.size());
    }
    double* const in = &hits.blocks[hits.count / kLanes].in[hits.count % kLanes];
    put(in, kOrigin, glm::dvec3(ray.origin));
    put(in, kDirection, glm::dvec3(ray.direction));
    in[kT * kLanes] = static_cast<double>(hit.t);
    put_shape(in, scene, at.object.shape, hit.primitive);
    Wanted& wanted = hits.wanted[hits.count++];
    wanted.material = at.material;
    wanted.hit = &hit;
    wanted.result = &result;
}

void ShapeSurfaces::find() {
    HWY_DYNAMIC_DISPATCH(find_spheres)(used(spheres_.blocks, spheres_.count));
    HWY_DYNAMIC_DISPATCH(find_rectangles)(used(rectangles_.blocks, rectangles_.count));
    take(spheres_);
    take(rectangles_);
}

void ShapeSurfaces::take(const Hits& hits) {
    for (std::size_t i = 0; i < hits.count; ++i)
        take(hits.wanted[i], hits.blocks[i / kLanes], i % kLanes);
}

void ShapeSurfaces::take(const Wanted& wanted, const Block& block, std::size_t lane) {
    const float* const out = &block.out[lane];
    SurfacePoint& surface = *wanted.result;
    surface.position = vector_at<kLanes>(out, kPosition);
    surface.position_error = vector_at<kLanes>(out, kError);
    surface.geometric_normal = vector_at<kLanes>(out, kNormal);
    surface.shading_normal = vector_at<kLanes>(out, kNormal);
    set_untextured(*wanted.hit, wanted.material, surface);
}

}  // namespace raypick

#endif  // HWY_ONCE
