#include "tracer/shade/branches.h"

#include "tracer/shade/fresnel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace raypick {

namespace {

// Mirror direction about the shading normal; about the geometric one where the former would lead
// into the surface.
glm::vec3 reflect_direction(const ShadingPoint& point) {
    const auto about = [&](const glm::vec3& n) {
        return glm::normalize(point.incoming - 2.0f * glm::dot(point.incoming, n) * n);
    };
    const glm::vec3 mirrored = about(point.normal);
    return glm::dot(mirrored, point.geometric) > 0.0f ? mirrored : about(point.geometric);
}

// Snell's law at a normal on the ray's side; nothing on total internal reflection. `eta` is the
// index before over the index beyond.
std::optional<glm::vec3> refract(const glm::vec3& incoming, const glm::vec3& normal, float eta) {
    const float cosine = -glm::dot(incoming, normal);
    const float squared = 1.0f - eta * eta * (1.0f - cosine * cosine);
    if (!(squared >= 0.0f)) return std::nullopt;
    return glm::normalize(eta * incoming + (eta * cosine - std::sqrt(squared)) * normal);
}

// About the shading normal; about the geometric one where the former faces away or leads the ray
// back.
std::optional<glm::vec3> refract_direction(const ShadingPoint& point, float eta) {
    if (eta == 1.0f) return point.incoming;
    if (glm::dot(point.incoming, point.normal) < 0.0f) {
        const auto refracted = refract(point.incoming, point.normal, eta);
        if (!refracted || glm::dot(*refracted, point.geometric) < 0.0f) return refracted;
    }
    return refract(point.incoming, point.geometric, eta);
}

// What leaves a surface: shares of a mirrored and of a transmitted ray.
struct Split {
    glm::vec3 mirrored{0.0f};
    glm::vec3 transmitted{0.0f};
    std::optional<glm::vec3> through;  // direction of the transmitted ray
};

// Of a dielectric that nothing enters: a coat of varnish.
float fresnel_outside(const ShadingPoint& point, float cosine) {
    const float ior = point.kind.ior;
    return fresnel_dielectric(cosine, point.surface.front_face ? 1.0f / ior : ior);
}

void apply_fresnel(const ShadingPoint& point, const Boundary& boundary, Split& split) {
    const Material& kind = point.kind;
    const float cosine = std::clamp(-glm::dot(point.incoming, point.normal), 0.0f, 1.0f);
    if (kind.reflectance == Reflectance::dielectric) {
        const float f = kind.thin_walled               ? fresnel_sheet(cosine, 1.0f / kind.ior)
                        : boundary.crossing != nullptr ? fresnel_dielectric(cosine, boundary.eta)
                                                       : fresnel_outside(point, cosine);
        split.mirrored *= f;
        if (split.through) split.transmitted *= 1.0f - f;
    } else if (split.mirrored != glm::vec3(0.0f)) {
        split.mirrored = fresnel_conductor(split.mirrored, cosine);
    }
}

Split split_at(const RenderSettings& settings, const ShadingPoint& point,
               const Boundary& boundary) {
    Split split;
    const bool refracts = settings.refractions && point.kind.transmits();
    if (refracts) {
        split.through = refract_direction(point, boundary.eta);
        split.transmitted = point.material.transmit;
    }
    if (settings.reflections) split.mirrored = point.material.reflect;
    const bool constant = point.kind.reflectance == Reflectance::constant;
    if (!constant) apply_fresnel(point, boundary, split);
    if (refracts && !split.through) {  // total internal reflection
        if (constant || !settings.reflections) split.mirrored += split.transmitted;
    }
    return split;
}

// Collects what is worth a ray.
class Collector {
public:
    Collector(float cutoff, float weight, Branches& found)
        : cutoff_(cutoff), weight_(weight), found_(found) {
        found_.count = 0;
    }

    // `direction` is asked only for a ray that is shot.
    template <typename Direction>
    void add(BranchKind kind, const glm::vec3& share, const Direction& direction) {
        const float weight = weight_ * largest(share);
        if (cutoff_ != 0.0f && !(weight > cutoff_)) return;
        Branch& branch = found_.branch[found_.count++];
        branch.kind = kind;
        branch.direction = direction();
        branch.share = share;
        branch.weight = weight;
    }

private:
    float cutoff_;
    float weight_;
    Branches& found_;
};

}  // namespace

void find_branches(const ShadeScene& scene, const ShadingPoint& point, const Boundary& boundary,
                   float weight, Branches& found) {
    const RenderSettings& settings = scene.settings;
    const float opacity = point.material.opacity;
    const Material& kind = point.kind;
    const bool transmits = settings.refractions && kind.transmits();
    const bool mirrors = settings.reflections && (kind.reflects() || kind.transmits());
    Collector collector(settings.cutoff, weight, found);
    if (transmits || mirrors) {
        const Split split = split_at(settings, point, boundary);
        if (transmits && split.through) {
            collector.add(BranchKind::transmitted, opacity * split.transmitted,
                          [&] { return *split.through; });
        }
        if (mirrors || split.mirrored != glm::vec3(0.0f)) {
            collector.add(BranchKind::mirrored, opacity * split.mirrored,
                          [&] { return reflect_direction(point); });
        }
    }
    if (opacity < 1.0f && settings.refractions) {
        collector.add(BranchKind::straight, glm::vec3(1.0f - opacity),
                      [&] { return point.incoming; });
    }
}

std::uint64_t branch_seed(const ShadeScene& scene, std::uint64_t seed, BranchKind kind) {
    if (!scene.draws_lots) return seed;
    return RandomSequence::derive(seed, static_cast<std::uint64_t>(kind));
}

}  // namespace raypick
