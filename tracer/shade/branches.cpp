#include "tracer/shade/branches.h"

#include "tracer/shade/fresnel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

// Directions and shares are put by their numbers where they are wanted: a copy of a vector that was
// just put together makes processors wait for its parts.
void put(const glm::vec3& from, glm::vec3& to) {
    to.x = from.x;
    to.y = from.y;
    to.z = from.z;
}

// Mirror direction about the shading normal; about the geometric one where the former would lead
// into the surface.
void reflect_direction(const ShadingPoint& point, glm::vec3& mirrored) {
    const auto about = [&](const glm::vec3& n) {
        put(glm::normalize(point.incoming - 2.0f * glm::dot(point.incoming, n) * n), mirrored);
    };
    about(point.normal);
    if (!(glm::dot(mirrored, point.geometric) > 0.0f)) about(point.geometric);
}

// Snell's law at a normal on the ray's side; false on total internal reflection. `eta` is the index
// before over the index beyond.
bool refract(const glm::vec3& incoming, const glm::vec3& normal, float eta, glm::vec3& refracted) {
    const float cosine = -glm::dot(incoming, normal);
    const float squared = 1.0f - eta * eta * (1.0f - cosine * cosine);
    if (!(squared >= 0.0f)) return false;
    put(glm::normalize(eta * incoming + (eta * cosine - std::sqrt(squared)) * normal), refracted);
    return true;
}

// About the shading normal; about the geometric one where the former faces away or leads the ray
// back.
bool refract_direction(const ShadingPoint& point, float eta, glm::vec3& refracted) {
    if (eta == 1.0f) {
        put(point.incoming, refracted);
        return true;
    }
    if (glm::dot(point.incoming, point.normal) < 0.0f) {
        if (!refract(point.incoming, point.normal, eta, refracted)) return false;
        if (glm::dot(refracted, point.geometric) < 0.0f) return true;
    }
    return refract(point.incoming, point.geometric, eta, refracted);
}

// Of a dielectric that nothing enters: a coat of varnish.
float fresnel_outside(const ShadingPoint& point, float cosine) {
    const float ior = point.kind.ior;
    return fresnel_dielectric(cosine, point.surface.front_face ? 1.0f / ior : ior);
}

// What a dielectric reflects.
float reflected(const ShadingPoint& point, const Boundary& boundary, float cosine) {
    const Material& kind = point.kind;
    if (kind.thin_walled) return fresnel_sheet(cosine, 1.0f / kind.ior);
    if (boundary.crossing != nullptr) return fresnel_dielectric(cosine, boundary.eta);
    return fresnel_outside(point, cosine);
}

// Collects what is worth a ray.
class Collector {
public:
    Collector(float cutoff, float weight, Branches& found)
        : cutoff_(cutoff), weight_(weight), found_(found) {
        found_.count = 0;
    }

    // The ray's direction is to be set; nullptr: none is shot.
    Branch* add(BranchKind kind, const glm::vec3& share) {
        const float weight = weight_ * largest(share);
        if (cutoff_ != 0.0f && !(weight > cutoff_)) return nullptr;
        Branch& branch = found_.branch[found_.count++];
        branch.kind = kind;
        put(share, branch.share);
        branch.weight = weight;
        return &branch;
    }

private:
    float cutoff_;
    float weight_;
    Branches& found_;
};

// What a surface that mirrors or lets light through sends on.
void add_split(const RenderSettings& settings, const ShadingPoint& point, const Boundary& boundary,
               Collector& collector) {
    const Material& kind = point.kind;
    const SurfaceMaterial& material = point.material;
    const bool refracts = settings.refractions && kind.transmits();
    glm::vec3 through;
    const bool passes = refracts && refract_direction(point, boundary.eta, through);
    const bool constant = kind.reflectance == Reflectance::constant;
    glm::vec3 mirrored = settings.reflections ? material.reflect : glm::vec3(0.0f);
    glm::vec3 transmitted = material.transmit;
    if (!constant) {
        const float cosine = std::clamp(-glm::dot(point.incoming, point.normal), 0.0f, 1.0f);
        if (kind.reflectance == Reflectance::dielectric) {
            const float f = reflected(point, boundary, cosine);
            mirrored *= f;
            if (passes) transmitted *= 1.0f - f;
        } else if (mirrored != glm::vec3(0.0f)) {
            mirrored = fresnel_conductor(mirrored, cosine);
        }
    }
    // Total internal reflection.
    if (refracts && !passes && (constant || !settings.reflections)) mirrored += transmitted;
    const float opacity = material.opacity;
    if (passes) {
        Branch* branch = collector.add(BranchKind::transmitted, opacity * transmitted);
        if (branch != nullptr) put(through, branch->direction);
    }
    const bool mirrors = settings.reflections && (kind.reflects() || kind.transmits());
    if (mirrors || mirrored != glm::vec3(0.0f)) {
        Branch* branch = collector.add(BranchKind::mirrored, opacity * mirrored);
        if (branch != nullptr) reflect_direction(point, branch->direction);
    }
}

}  // namespace

void find_branches(const ShadeScene& scene, const ShadingPoint& point, const Boundary& boundary,
                   float weight, Branches& found) {
    const RenderSettings& settings = scene.settings;
    const float opacity = point.material.opacity;
    const Material& kind = point.kind;
    Collector collector(settings.cutoff, weight, found);
    if ((settings.refractions && kind.transmits()) ||
        (settings.reflections && (kind.reflects() || kind.transmits()))) {
        add_split(settings, point, boundary, collector);
    }
    if (opacity < 1.0f && settings.refractions) {
        Branch* branch = collector.add(BranchKind::straight, glm::vec3(1.0f - opacity));
        if (branch != nullptr) put(point.incoming, branch->direction);
    }
}

std::uint64_t branch_seed(const ShadeScene& scene, std::uint64_t seed, BranchKind kind) {
    if (!scene.draws_lots) return seed;
    return RandomSequence::derive(seed, static_cast<std::uint64_t>(kind));
}

}  // namespace raypick
