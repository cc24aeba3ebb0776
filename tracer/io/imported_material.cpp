#include "tracer/io/imported_material.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace raypick {

namespace {

constexpr double kLargestShininess = 8192.0;

float shininess_in_range(double exponent) {
    return static_cast<float>(std::clamp(exponent, 1.0, kLargestShininess));
}

// The Phong exponent of a surface of this roughness.
float shininess_of(double roughness) {
    const double alpha = roughness * roughness;
    if (!(alpha > 0.0)) return shininess_in_range(kLargestShininess);
    return shininess_in_range(2.0 / (alpha * alpha) - 2.0);
}

Material unlit_material(const GltfMaterial& gltf) {
    Material material;
    material.name = gltf.name;
    material.ambient = material.diffuse = material.specular = glm::vec3(0.0f);
    material.emissive = gltf.base;
    return material;
}

}  // namespace

Material material_from(const MtlMaterial& mtl) {
    const double opacity = std::clamp(mtl.d ? *mtl.d : 1.0 - mtl.tr.value_or(0.0), 0.0, 1.0);
    const bool highlights = mtl.illum != 0 && mtl.illum != 1;
    const bool mirror = mtl.illum >= 3 && mtl.illum <= 8;
    const bool refracts = mtl.illum == 6 || mtl.illum == 7;
    const bool glass = refracts || mtl.illum == 4 || mtl.illum == 9;
    Material material;
    material.name = mtl.name;
    material.diffuse = mtl.kd * static_cast<float>(opacity);
    material.ambient = material.diffuse;
    material.specular = highlights ? mtl.ks : glm::vec3(0.0f);
    material.shininess = shininess_in_range(mtl.ns);
    material.emissive = mtl.ke;
    material.reflect = mirror ? mtl.ks : glm::vec3(0.0f);
    material.transmit = mtl.tf * static_cast<float>(1.0 - opacity);
    if (refracts && opacity == 1.0) {
        material.transmit = mtl.tf * glm::max(glm::vec3(1.0f) - mtl.ks, glm::vec3(0.0f));
    }
    material.ior = glass && mtl.ni && *mtl.ni > 0.0 ? static_cast<float>(*mtl.ni) : 1.0f;
    return material;
}

Material material_from(const GltfMaterial& gltf) {
    if (gltf.unlit) return unlit_material(gltf);
    const auto metallic = static_cast<float>(gltf.metallic_texture ? 0.0 : gltf.metallic);
    const auto transmission = static_cast<float>(gltf.transmission);
    const auto polish = static_cast<float>((1.0 - gltf.roughness) * (1.0 - gltf.roughness));
    const double f0_root = (gltf.ior - 1.0) / (gltf.ior + 1.0);
    const glm::vec3 f0(static_cast<float>(f0_root * f0_root));
    const glm::vec3 dielectric = gltf.base * (1.0f - metallic);
    Material material;
    material.name = gltf.name;
    material.diffuse = dielectric * (1.0f - transmission);
    material.specular = glm::mix(f0, gltf.base, metallic);
    material.shininess = shininess_of(gltf.roughness);
    material.reflect = glm::mix(f0 * transmission, gltf.base, metallic) * polish;
    material.ambient = material.diffuse + gltf.base * metallic * (1.0f - polish);
    material.transmit = dielectric * transmission;
    material.ior = gltf.thickness > 0.0 ? static_cast<float>(gltf.ior) : 1.0f;
    material.emissive = gltf.emissive;
    if (gltf.blend && gltf.alpha < 1.0) {
        const auto alpha = static_cast<float>(gltf.alpha);
        material.diffuse *= alpha;
        material.ambient *= alpha;
        material.reflect *= alpha;
        material.transmit = material.transmit * alpha + glm::vec3(1.0f - alpha);
    }
    return material;
}

}  // namespace raypick
