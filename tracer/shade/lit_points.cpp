#include "tracer/shade/lit_points.h"

#include "tracer/shade/lit_point.h"

#include <algorithm>
#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/shade/lit_points.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "tracer/accel/simd/triples-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

namespace {

using Doubles = hn::CappedTag<double, 8>;
using Singles = hn::CappedTag<float, LitPoints::kLanes>;

template <class D>
HWY_INLINE Triple<hn::Vec<D>> same(D d, const glm::vec<3, hn::TFromD<D>>& v) {
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

// A block's rows from lane i on.
class Lanes {
public:
    HWY_INLINE Lanes(LitPoints::Block& block, std::size_t i) : first_(&block.row[i]) {}

    template <class D>
    HWY_INLINE hn::Vec<D> load(D d, std::size_t row) const {
        return hn::LoadU(d, first_ + row * LitPoints::kLanes);
    }
    template <class D>
    HWY_INLINE Triple<hn::Vec<D>> load3(D d, std::size_t row) const {
        return {load(d, row), load(d, row + 1), load(d, row + 2)};
    }
    template <class D>
    HWY_INLINE void store(D d, std::size_t row, hn::Vec<D> v) const {
        hn::StoreU(v, d, first_ + row * LitPoints::kLanes);
    }
    template <class D>
    HWY_INLINE void store3(D d, std::size_t row, const Triple<hn::Vec<D>>& v) const {
        store(d, row, v.x);
        store(d, row + 1, v.y);
        store(d, row + 2, v.z);
    }

private:
    float* first_;
};

template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint32_t bits) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                   static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(d, bytes);
}
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0] | std::uint32_t{bytes[1]} << 8;
}

// next_float.
HWY_INLINE hn::Vec<Singles> next_float(hn::Vec<Singles> x, hn::Vec<Singles> way) {
    const Singles d;
    const hn::RebindToUnsigned<Singles> u;
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(u, 1);
    const auto bits = hn::BitCast(u, x);
    const auto out = hn::Not(hn::Xor(hn::Gt(x, zero), hn::Gt(way, zero)));  // away from 0
    const auto stepped = hn::BitCast(
        d, hn::IfThenElse(hn::RebindMask(u, out), hn::Add(bits, one), hn::Sub(bits, one)));
    const auto least = hn::CopySign(hn::BitCast(d, one), way);
    const auto stays = hn::Or(hn::Or(hn::Eq(way, zero), hn::IsNaN(x)), hn::And(hn::IsInf(x), out));
    return hn::IfThenElse(stays, x, hn::IfThenElse(hn::Eq(x, zero), least, stepped));
}

// offset_origin on the side of this normal.
HWY_INLINE Triple<hn::Vec<Singles>> offset_origin(const Lanes& lanes,
                                                  const Triple<hn::Vec<Singles>>& normal) {
    const Singles d;
    const auto error = lanes.load3(d, LitPoints::kOutside);
    const auto distance = hn::Mul(hn::Set(d, 2.0f), dot(size(normal), error));
    const auto origin = plus(lanes.load3(d, LitPoints::kPosition), times(distance, normal));
    return {next_float(origin.x, normal.x), next_float(origin.y, normal.y),
            next_float(origin.z, normal.z)};
}

// reflect_direction of branches.cpp, and set_leaving.
HWY_INLINE void mirror(const Lanes& lanes, std::uint32_t front) {
    const Singles d;
    const auto zero = hn::Zero(d);
    const auto negative = [](const Triple<hn::Vec<Singles>>& v) HWY_ATTR {
        return Triple<hn::Vec<Singles>>{hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
    };
    const auto choose = [](hn::Mask<Singles> which, const Triple<hn::Vec<Singles>>& a,
                           const Triple<hn::Vec<Singles>>& b) HWY_ATTR {
        return Triple<hn::Vec<Singles>>{hn::IfThenElse(which, a.x, b.x),
                                        hn::IfThenElse(which, a.y, b.y),
                                        hn::IfThenElse(which, a.z, b.z)};
    };
    const auto incoming = negative(lanes.load3(d, LitPoints::kToEye));
    const auto about = [&](const Triple<hn::Vec<Singles>>& n) HWY_ATTR {
        const auto mirrored =
            minus(incoming, times(hn::Mul(hn::Set(d, 2.0f), dot(incoming, n)), n));
        return times(hn::Div(hn::Set(d, 1.0f), hn::Sqrt(dot(mirrored, mirrored))), mirrored);
    };
    const auto geometric = lanes.load3(d, LitPoints::kGeometric);
    auto mirrored = about(lanes.load3(d, LitPoints::kNormal));
    const auto away = hn::Gt(dot(mirrored, geometric), zero);
    if (!hn::AllTrue(d, away)) mirrored = choose(away, mirrored, about(geometric));
    const auto outward = choose(mask_of(d, front), geometric, negative(geometric));
    const auto side = choose(hn::Ge(dot(outward, mirrored), zero), outward, negative(outward));
    lanes.store3(d, LitPoints::kMirrored, mirrored);
    lanes.store3(d, LitPoints::kMirroredOrigin, offset_origin(lanes, side));
}

// light_towards, for lights that shine the same everywhere and shares of 1.
HWY_INLINE void shine_from_point(const PreparedLight& light, const Lanes& lanes) {
    const Doubles d;
    const hn::Rebind<float, Doubles> f;
    const auto number = [d](double x) HWY_ATTR { return hn::Set(d, x); };
    const auto from = lanes.load3(f, LitPoints::kPosition);
    const Triple<hn::Vec<Doubles>> offset =
        minus(same(d, light.position),
              {hn::PromoteTo(d, from.x), hn::PromoteTo(d, from.y), hn::PromoteTo(d, from.z)});
    const auto distance = hn::Sqrt(dot(offset, offset));
    const auto somewhere = hn::Gt(distance, number(0.0));
    const auto to_light = times(hn::Div(number(1.0), distance), offset);
    const Attenuation& a = light.attenuation;
    auto weakening = number(a.constant);
    if (a.linear != 0.0 || a.quadratic != 0.0) {
        const auto slope = hn::Add(number(a.linear), hn::Mul(distance, number(a.quadratic)));
        weakening = hn::Add(weakening, hn::Mul(distance, slope));
    }
    const auto colour = times(hn::Div(number(1.0), weakening), same(d, glm::dvec3(light.colour)));
    const auto rounded = [&](hn::Vec<Doubles> v)
                             HWY_ATTR { return hn::DemoteTo(f, hn::IfThenElseZero(somewhere, v)); };
    lanes.store3(f, LitPoints::kToLight,
                 {rounded(to_light.x), rounded(to_light.y), rounded(to_light.z)});
    lanes.store(f, LitPoints::kDistance, rounded(distance));
    lanes.store3(f, LitPoints::kLight, {rounded(colour.x), rounded(colour.y), rounded(colour.z)});
}

HWY_INLINE std::uint32_t facing(const Lanes& lanes, bool shadows) {
    const Singles d;
    const auto zero = hn::Zero(d);
    const auto to_light = lanes.load3(d, LitPoints::kToLight);
    const auto light = lanes.load3(d, LitPoints::kLight);
    auto faces = hn::Gt(dot(lanes.load3(d, LitPoints::kNormal), to_light), zero);
    faces = hn::And(
        faces, hn::Or(hn::Or(hn::Ne(light.x, zero), hn::Ne(light.y, zero)), hn::Ne(light.z, zero)));
    if (shadows) {
        const auto geometric = lanes.load3(d, LitPoints::kGeometric);
        faces = hn::And(faces, hn::Gt(dot(geometric, to_light), zero));
    }
    return bits_of(d, faces);
}

// local_light of as many points as a vector holds, with the highlights' powers one by one.
class LocalLight {
public:
    HWY_INLINE LocalLight(const LitPoints::Block& block, const Lanes& lanes, std::size_t i)
        : lanes_(lanes), lit_(block.lit >> i), shiny_(block.shiny >> i), blinn_(block.blinn >> i) {}

    // Adds it to the points' colours.
    HWY_INLINE void add() const {
        const Singles d;
        const auto normal = lanes_.load3(d, LitPoints::kNormal);
        const auto to_light = lanes_.load3(d, LitPoints::kToLight);
        const auto diffuse = dot(normal, to_light);
        Vector3 local = times(diffuse, lanes_.load3(d, LitPoints::kDiffuse));
        if ((lit_ & shiny_ & kAll) != 0) {
            const auto highlight = highlights(lobes(normal, to_light, diffuse));
            const Vector3 both =
                plus(local, times(highlight, lanes_.load3(d, LitPoints::kSpecular)));
            const auto shiny = mask_of(d, shiny_);
            local = {hn::IfThenElse(shiny, both.x, local.x), hn::IfThenElse(shiny, both.y, local.y),
                     hn::IfThenElse(shiny, both.z, local.z)};
        }
        const auto before = lanes_.load3(d, LitPoints::kColour);
        const Vector3 after = plus(before, times(lanes_.load3(d, LitPoints::kLight), local));
        const auto lit = mask_of(d, lit_);
        lanes_.store3(
            d, LitPoints::kColour,
            {hn::IfThenElse(lit, after.x, before.x), hn::IfThenElse(lit, after.y, before.y),
             hn::IfThenElse(lit, after.z, before.z)});
    }

private:
    using Vector = hn::Vec<Singles>;
    using Vector3 = Triple<Vector>;
    static constexpr std::uint32_t kAll = (1u << hn::MaxLanes(Singles())) - 1u;

    HWY_INLINE Vector lobes(const Vector3& normal, const Vector3& to_light, Vector diffuse) const {
        const Singles d;
        const auto to_eye = lanes_.load3(d, LitPoints::kToEye);
        const Vector3 mirrored = minus(times(hn::Mul(hn::Set(d, 2.0f), diffuse), normal), to_light);
        const auto phong = dot(mirrored, to_eye);
        if ((lit_ & blinn_ & kAll) == 0) return phong;
        const Vector3 sum = plus(to_light, to_eye);
        const auto length = hn::Sqrt(dot(sum, sum));
        const auto lobe =
            hn::IfThenElseZero(hn::Gt(length, hn::Zero(d)), hn::Div(dot(normal, sum), length));
        return hn::IfThenElse(mask_of(d, blinn_), lobe, phong);
    }

    HWY_INLINE Vector highlights(Vector lobe) const {
        const Singles d;
        alignas(64) float at[LitPoints::kLanes];
        alignas(64) float shininess[LitPoints::kLanes];
        hn::Store(lobe, d, at);
        hn::Store(lanes_.load(d, LitPoints::kShininess), d, shininess);
        for (std::uint32_t left = lit_ & shiny_ & kAll; left != 0; left &= left - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(left));
            at[k] = highlight(at[k], shininess[k]);
        }
        return hn::Load(d, at);
    }

    const Lanes& lanes_;
    std::uint32_t lit_;
    std::uint32_t shiny_;
    std::uint32_t blinn_;
};

}  // namespace

// set_lit_point, but for the material.
void take_ends(const SurfaceRows& ends, LitPoints::Block& block) {
    const Singles d;
    for (std::size_t i = 0; i < LitPoints::kLanes; i += hn::Lanes(d)) {
        const Lanes lanes(block, i);
        const auto front = mask_of(d, ends.front >> i);
        const auto of_end = [&](std::size_t row) HWY_ATTR {
            return hn::Load(d, &ends.row[row * SurfaceRows::kLanes + i]);
        };
        const auto turned = [&](std::size_t row) HWY_ATTR {
            const auto outward = of_end(row);
            return hn::IfThenElse(front, outward, hn::Neg(outward));
        };
        for (std::size_t k = 0; k < 3; ++k) {
            lanes.store(d, LitPoints::kPosition + k, of_end(SurfaceRows::kPosition + k));
            lanes.store(d, LitPoints::kOutside + k, of_end(SurfaceRows::kError + k));
            lanes.store(d, LitPoints::kNormal + k, turned(SurfaceRows::kShading + k));
            lanes.store(d, LitPoints::kGeometric + k, turned(SurfaceRows::kGeometric + k));
            lanes.store(d, LitPoints::kToEye + k, hn::Neg(of_end(SurfaceRows::kDirection + k)));
        }
    }
}

void mirror(std::span<LitPoints::Block> blocks) {
    for (LitPoints::Block& block : blocks) {
        for (std::size_t i = 0; block.mirrors && i < LitPoints::kLanes; i += hn::Lanes(Singles())) {
            mirror(Lanes(block, i), block.front >> i);
        }
    }
}

void leave_surfaces(std::span<LitPoints::Block> blocks) {
    const Singles d;
    for (LitPoints::Block& block : blocks) {
        for (std::size_t i = 0; i < LitPoints::kLanes; i += hn::Lanes(d)) {
            const Lanes lanes(block, i);
            lanes.store3(d, LitPoints::kOutside,
                         offset_origin(lanes, lanes.load3(d, LitPoints::kGeometric)));
        }
    }
}

void shine_from_point(const PreparedLight& light, std::span<LitPoints::Block> blocks) {
    for (LitPoints::Block& block : blocks) {
        for (std::size_t i = 0; i < LitPoints::kLanes; i += hn::Lanes(Doubles()))
            shine_from_point(light, Lanes(block, i));
    }
}

void face_light(std::span<LitPoints::Block> blocks, bool shadows) {
    for (LitPoints::Block& block : blocks) {
        block.lit = 0;
        for (std::size_t i = 0; i < LitPoints::kLanes; i += hn::Lanes(Singles()))
            block.lit |= facing(Lanes(block, i), shadows) << i;
        block.lit &= block.used;
    }
}

void gather_light(std::span<LitPoints::Block> blocks) {
    for (LitPoints::Block& block : blocks) {
        if (block.lit == 0) continue;
        for (std::size_t i = 0; i < LitPoints::kLanes; i += hn::Lanes(Singles()))
            LocalLight(block, Lanes(block, i), i).add();
    }
}

}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raypick {

HWY_EXPORT(take_ends);
HWY_EXPORT(mirror);
HWY_EXPORT(leave_surfaces);
HWY_EXPORT(shine_from_point);
HWY_EXPORT(face_light);
HWY_EXPORT(gather_light);

namespace {

void put(LitPoints::Block& block, std::size_t lane, std::size_t row, const glm::vec3& v) {
    put_vector<LitPoints::kLanes>(&block.row[lane], row, v);
}

void put(LitPoints::Block& block, std::size_t lane, const LightSample& light) {
    put(block, lane, LitPoints::kToLight, light.direction);
    block.row[LitPoints::kDistance * LitPoints::kLanes + lane] = light.distance;
    put(block, lane, LitPoints::kLight, light.colour);
}

}  // namespace

std::size_t LitPoints::add(const SurfaceRows& ends) {
    if (count_ == blocks_.size()) blocks_.resize(2 * blocks_.size() + 1);
    Block& block = blocks_[count_];
    block.used = (1u << ends.count) - 1u;
    block.front = ends.front;
    block.shiny = block.blinn = 0;
    block.mirrors = false;
    HWY_DYNAMIC_DISPATCH(take_ends)(ends, block);
    return kLanes * count_++;
}

void LitPoints::set_material(std::size_t i, const SurfaceMaterial& material, const glm::vec3& own) {
    Block& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    put(block, lane, kDiffuse, material.diffuse);
    put(block, lane, kColour, own);
    block.opacity[lane] = material.opacity;
    const auto bit = [lane](bool is) { return (is ? 1u : 0u) << lane; };
    if (material.specular != glm::vec3(0.0f)) {
        put(block, lane, kSpecular, material.specular);
        block.row[kShininess * kLanes + lane] = material.shininess;
        block.shiny |= bit(true);
    }
    block.blinn |= bit(material.model != LocalModel::phong);
}

void LitPoints::set_materials(std::size_t first, const SurfaceMaterial& material,
                              const glm::vec3& own) {
    Block& block = blocks_[first / kLanes];
    const auto fill = [&block](std::size_t row, float number) {
        std::fill_n(&block.row[row * kLanes], kLanes, number);
    };
    const auto fill3 = [&fill](std::size_t row, const glm::vec3& v) {
        fill(row, v.x);
        fill(row + 1, v.y);
        fill(row + 2, v.z);
    };
    fill3(kDiffuse, material.diffuse);
    fill3(kColour, own);
    block.opacity.fill(material.opacity);
    const bool shiny = material.specular != glm::vec3(0.0f);
    if (shiny) {
        fill3(kSpecular, material.specular);
        fill(kShininess, material.shininess);
    }
    block.shiny = shiny ? block.used : 0;
    block.blinn = material.model != LocalModel::phong ? block.used : 0;
}

void LitPoints::set_normal(std::size_t i, const glm::vec3& normal) {
    put(blocks_[i / kLanes], i % kLanes, kNormal, normal);
}

void LitPoints::mirror() {
    HWY_DYNAMIC_DISPATCH(mirror)(used());
}

void LitPoints::take_mirrored(std::size_t i, Ray& ray) const {
    const float* const row = &blocks_[i / kLanes].row[i % kLanes];
    ray.origin = vector_at<kLanes>(row, kMirroredOrigin);
    ray.direction = vector_at<kLanes>(row, kMirrored);
    ray.t_min = 0.0f;
    ray.t_max = std::numeric_limits<float>::infinity();
}

void LitPoints::leave_surfaces() {
    HWY_DYNAMIC_DISPATCH(leave_surfaces)(used());
}

void LitPoints::shine(const PreparedLight& light) {
    if (light.kind == PreparedLight::Kind::point) {
        HWY_DYNAMIC_DISPATCH(shine_from_point)(light, used());
        return;
    }
    for (Block& block : used()) {
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            put(block, lane, light_sample(light, glm::dvec3(0.0), 0, 0));
    }
}

void LitPoints::shine(std::size_t i, const LightSample& light) {
    put(blocks_[i / kLanes], i % kLanes, light);
}

void LitPoints::face_light(bool shadows) {
    HWY_DYNAMIC_DISPATCH(face_light)(used(), shadows);
}

std::size_t LitPoints::take_shadow_rays(std::span<Ray> rays,
                                        std::span<std::uint32_t> points) const {
    std::size_t taken = 0;
    std::uint32_t first = 0;
    for (const Block& block : used()) {
        for (std::uint32_t left = block.lit; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
            const float* const row = &block.row[lane];
            Ray& ray = rays[taken];
            ray.origin = vector_at<kLanes>(row, kOutside);
            ray.direction = vector_at<kLanes>(row, kToLight);
            ray.t_min = 0.0f;
            ray.t_max = shadow_reach(row[kDistance * kLanes]);
            points[taken++] = first + lane;
        }
        first += kLanes;
    }
    return taken;
}

void LitPoints::tint(std::size_t i, const glm::vec3& share) {
    put(blocks_[i / kLanes], i % kLanes, kLight, share * at(i, kLight));
}

void LitPoints::gather() {
    HWY_DYNAMIC_DISPATCH(gather_light)(used());
}

}  // namespace raypick

#endif  // HWY_ONCE
