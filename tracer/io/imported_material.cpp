#include "tracer/io/imported_material.h"

#include "tracer/scene/limits.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raypick {

namespace {

constexpr double kLargestShininess = 8192.0;

float shininess_in_range(double exponent) {
    return static_cast<float>(std::clamp(exponent, 1.0, kLargestShininess));
}

// The Phong exponent of a surface of this roughness.
float shininess_of(float roughness) {
    const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
    if (!(alpha > 0.0)) return shininess_in_range(kLargestShininess);
    return shininess_in_range(2.0 / (alpha * alpha) - 2.0);
}

// A colour of an MTL file; white where a map says it all.
glm::vec3 mapped_or(const MtlMaterial& mtl, MtlMapKind kind, const std::optional<glm::vec3>& colour,
                    float otherwise) {
    if (!mtl.has_map(kind)) return colour.value_or(glm::vec3(otherwise));
    return colour && *colour != glm::vec3(0.0f) ? *colour : glm::vec3(1.0f);
}

Material unlit_material(const GltfMaterial& gltf) {
    Material material;
    material.name = gltf.name;
    material.ambient = material.diffuse = material.specular = glm::vec3(0.0f);
    material.emissive = gltf.pbr.base;
    return material;
}

}  // namespace

bool MtlMaterial::has_map(MtlMapKind kind) const {
    return std::any_of(maps.begin(), maps.end(),
                       [&](const MtlMap& map) { return map.kind == kind; });
}

void MtlMaterial::set_map(MtlMap map) {
    maps.erase(std::remove_if(maps.begin(), maps.end(),
                              [&](const MtlMap& old) { return old.kind == map.kind; }),
               maps.end());
    maps.push_back(std::move(map));
}

Material material_from(const MtlMaterial& mtl) {
    const double d = std::clamp(mtl.d ? *mtl.d : 1.0 - mtl.tr.value_or(0.0), 0.0, 1.0);
    const bool opacity_map =
        mtl.has_map(MtlMapKind::opacity) || mtl.has_map(MtlMapKind::transparency);
    // What is not there by a map is not there for the light either, so it is not transmitted.
    const double opacity = opacity_map ? 1.0 : d;
    const bool highlights = mtl.illum != 0 && mtl.illum != 1;
    const bool mirror = mtl.illum >= 3 && mtl.illum <= 8;
    const bool refracts = mtl.illum == 6 || mtl.illum == 7;
    const bool glass = refracts || mtl.illum == 4 || mtl.illum == 9;
    const glm::vec3 kd = mapped_or(mtl, MtlMapKind::diffuse, mtl.kd, 0.8f);
    const glm::vec3 ks = mapped_or(mtl, MtlMapKind::specular, mtl.ks, 0.0f);
    const glm::vec3 most_bounce(static_cast<float>(kMostBounce));
    Material material;
    material.name = mtl.name;
    material.diffuse = kd * static_cast<float>(opacity);
    material.ambient = material.diffuse;
    material.specular = highlights ? ks : glm::vec3(0.0f);
    material.shininess = shininess_in_range(mtl.ns);
    material.emissive = mapped_or(mtl, MtlMapKind::emissive, mtl.ke, 0.0f);
    material.reflect = mirror ? glm::min(ks, most_bounce) : glm::vec3(0.0f);
    material.transmit = mtl.tf * static_cast<float>(1.0 - opacity);
    if (refracts && opacity == 1.0) {
        material.transmit = mtl.tf * glm::max(glm::vec3(1.0f) - ks, glm::vec3(0.0f));
    }
    material.transmit = glm::min(material.transmit, most_bounce);
    material.ior = glass && mtl.ni && *mtl.ni > 0.0 ? static_cast<float>(*mtl.ni) : 1.0f;
    if (mtl.illum == 5) material.reflectance = Reflectance::conductor;
    if (mtl.illum == 7) material.reflectance = Reflectance::dielectric;
    if (opacity_map && d < 1.0) {
        material.opacity = static_cast<float>(d);
        material.alpha_mode = AlphaMode::blend;
    }
    return material;
}

PhongTerms phong_terms(const PbrValues& pbr) {
    const float polish = (1.0f - pbr.roughness) * (1.0f - pbr.roughness);
    const glm::vec3 dielectric = pbr.base * (1.0f - pbr.metallic);
    const glm::vec3 glass = glm::min(pbr.tint, glm::vec3(1.0f)) * pbr.transmission;
    PhongTerms terms;
    terms.diffuse = dielectric * (1.0f - pbr.transmission);
    terms.ambient = terms.diffuse + pbr.base * pbr.metallic * (1.0f - polish);
    terms.specular = glm::mix(pbr.f0, pbr.base, pbr.metallic);
    terms.shininess = shininess_of(pbr.roughness);
    terms.reflect = glm::mix(glass, pbr.base, pbr.metallic) * polish;
    terms.transmit = dielectric * pbr.transmission;
    return terms;
}

int GltfMaterial::uv_set() const {
    for (const auto* map :
         {&base_map, &metallic_roughness_map, &transmission_map, &normal_map, &emissive_map}) {
        if (*map) return (*map)->uv_set;
    }
    return 0;
}

Material material_from(const GltfMaterial& gltf) {
    Material material;
    if (gltf.unlit) {
        material = unlit_material(gltf);
    } else {
        const PhongTerms terms = phong_terms(gltf.pbr);
        material.name = gltf.name;
        material.diffuse = terms.diffuse;
        material.ambient = terms.ambient;
        material.specular = terms.specular;
        material.shininess = terms.shininess;
        material.reflect = terms.reflect;
        material.transmit = terms.transmit;
        material.emissive = gltf.emissive;
        material.ior = static_cast<float>(gltf.ior);
        if (gltf.pbr.transmission > 0.0f) {
            material.reflectance = Reflectance::dielectric;
            material.thin_walled = !(gltf.thickness > 0.0);
            if (!material.thin_walled) material.absorption = gltf.absorption;
        } else if (material.reflects()) {
            material.reflectance = Reflectance::conductor;
        }
    }
    if (gltf.masked || gltf.blend) {
        material.opacity = gltf.alpha;
        material.alpha_mode = gltf.blend ? AlphaMode::blend : AlphaMode::cut_out;
        material.alpha_cutoff = gltf.alpha_cutoff;
    }
    return material;
}

}  // namespace raypick
