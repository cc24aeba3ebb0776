#include "tracer/accel/sphere_surfaces.h"

#include <algorithm>
#include <limits>
#include <variant>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/accel/sphere_surfaces.cpp"
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
class SphereKernel {
public:
    explicit SphereKernel(SphereSurfaces::Block& block) : block_(block) {}

    HWY_INLINE void run(std::size_t count) const {
        for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles()))
            step(i);
    }

private:
    using Floats = hn::Rebind<float, Doubles>;

    static HWY_INLINE DoubleVector number(double x) { return hn::Set(Doubles(), x); }
    static HWY_INLINE DoubleVector3 size(const DoubleVector3& a) {
        return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
    }

    HWY_INLINE DoubleVector load(std::size_t row, std::size_t i) const {
        return hn::LoadU(Doubles(), &block_.in[row * SphereSurfaces::kLanes + i]);
    }
    HWY_INLINE DoubleVector3 load3(std::size_t first, std::size_t i) const {
        return {load(first, i), load(first + 1, i), load(first + 2, i)};
    }
    HWY_INLINE void store(std::size_t first, std::size_t i, const DoubleVector3& a,
                          float more) const {
        const auto put = [&](std::size_t row, DoubleVector v) HWY_ATTR {
            const auto rounded = hn::DemoteTo(Floats(), v);
            hn::StoreU(hn::Add(rounded, hn::Set(Floats(), more)), Floats(),
                       &block_.out[row * SphereSurfaces::kLanes + i]);
        };
        put(first, a.x);
        put(first + 1, a.y);
        put(first + 2, a.z);
    }

    // sphere_t of local_point.cpp. `f`: from the centre to the origin.
    static HWY_INLINE DoubleVector exact_t(const DoubleVector3& f, const DoubleVector3& direction,
                                           DoubleVector radius, DoubleVector t) {
        const DoubleVector a = dot(direction, direction);
        const DoubleVector middle = hn::Div(hn::Neg(dot(f, direction)), a);
        const DoubleVector3 closest = plus(f, times(middle, direction));
        const DoubleVector squared =
            hn::Div(hn::Sub(hn::Mul(radius, radius), dot(closest, closest)), a);
        const DoubleVector half = hn::CopySign(hn::Sqrt(squared), hn::Sub(t, middle));
        return hn::IfThenElse(hn::Gt(squared, number(0.0)), hn::Add(middle, half), t);
    }

    HWY_INLINE void step(std::size_t i) const {
        using In = SphereSurfaces;
        const DoubleVector3 origin = load3(In::kOrigin, i);
        const DoubleVector3 direction = load3(In::kDirection, i);
        const DoubleVector3 centre = load3(In::kCentre, i);
        const DoubleVector radius = load(In::kRadius, i);
        const DoubleVector t = exact_t(minus(origin, centre), direction, radius, load(In::kT, i));
        const DoubleVector3 n = normalize(minus(plus(origin, times(t, direction)), centre));
        const DoubleVector3 position = plus(centre, times(radius, n));

        const DoubleVector3 away = size(centre);
        const DoubleVector magnitude = hn::Add(larger(larger(away.x, away.y), away.z), radius);
        const DoubleVector3 reach = size(position);
        const auto bound = [&](DoubleVector along) HWY_ATTR {
            return hn::Add(hn::Mul(along, number(0x1p-24)),
                           hn::Mul(hn::Add(along, magnitude), number(0x1p-47)));
        };
        store(In::kPosition, i, position, -0.0f);
        store(In::kError, i, {bound(reach.x), bound(reach.y), bound(reach.z)},
              std::numeric_limits<float>::min());
        store(In::kNormal, i, normalize(n), -0.0f);
    }

    SphereSurfaces::Block& block_;
};

}  // namespace

void find_spheres(std::span<SphereSurfaces::Block> blocks, std::size_t count) {
    constexpr std::size_t kLanes = SphereSurfaces::kLanes;
    for (std::size_t first = 0; first < count; first += kLanes)
        SphereKernel(blocks[first / kLanes]).run(std::min(kLanes, count - first));
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raypick {

HWY_EXPORT(find_spheres);

bool SphereSurfaces::takes(const HitObject& at) {
    return !at.textured && at.object_from_world.is_identity() &&
           (std::holds_alternative<SphereSetInstance>(at.object.shape) ||
            std::holds_alternative<Sphere>(at.object.shape));
}

void SphereSurfaces::add(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
                         SurfacePoint& result) {
    if (count_ == wanted_.size()) {
        blocks_.resize(2 * blocks_.size() + 1);
        wanted_.resize(kLanes * blocks_.size());
    }
    double* const in = &blocks_[count_ / kLanes].in[count_ % kLanes];
    const auto put = [in](std::size_t row, const glm::dvec3& v) {
        in[row * kLanes] = v.x;
        in[(row + 1) * kLanes] = v.y;
        in[(row + 2) * kLanes] = v.z;
    };
    put(kOrigin, glm::dvec3(ray.origin));
    put(kDirection, glm::dvec3(ray.direction));
    in[kT * kLanes] = static_cast<double>(hit.t);
    if (const auto* set = std::get_if<SphereSetInstance>(&at.object.shape)) {
        const glm::vec4& sphere = scene.sphere_sets[set->set].spheres[hit.primitive];
        put(kCentre, glm::dvec3(sphere));
        in[kRadius * kLanes] = static_cast<double>(sphere.w);
    } else {
        const Sphere& sphere = std::get<Sphere>(at.object.shape);
        put(kCentre, sphere.centre);
        in[kRadius * kLanes] = sphere.radius;
    }
    Wanted& wanted = wanted_[count_++];
    wanted.material = at.material;
    wanted.hit = &hit;
    wanted.result = &result;
}

void SphereSurfaces::find() {
    HWY_DYNAMIC_DISPATCH(find_spheres)(blocks_, count_);
    for (std::size_t i = 0; i < count_; ++i)
        take(wanted_[i], blocks_[i / kLanes], i % kLanes);
}

void SphereSurfaces::take(const Wanted& wanted, const Block& block, std::size_t lane) {
    const float* const out = &block.out[lane];
    const auto got = [out](std::size_t row, glm::vec3& v) {
        v.x = out[row * kLanes];
        v.y = out[(row + 1) * kLanes];
        v.z = out[(row + 2) * kLanes];
    };
    SurfacePoint& surface = *wanted.result;
    got(kPosition, surface.position);
    got(kError, surface.position_error);
    got(kNormal, surface.geometric_normal);
    got(kNormal, surface.shading_normal);
    surface.uv = wanted.hit->uv;
    surface.texture_uv = glm::vec2(0.0f);
    surface.dpdu = surface.dpdv = glm::vec3(0.0f);
    surface.front_face = wanted.hit->front_face;
    surface.material = wanted.material;
}

}  // namespace raypick

#endif  // HWY_ONCE
