// What other formats say of a surface, said in our Material. The whole mapping stands here.
//
// Colours in MTL and glTF files are taken as linear RGB, as glTF says; base for baseColorFactor.
//
// MTL (Wavefront; the later physically based keywords are not read)
//   diffuse   = Kd * d                  ambient = diffuse (Ka is nearly always left at 1 or 0)
//   specular  = Ks, none for illum 0 and 1          shininess = Ns in [1, 8192]
//   emissive  = Ke
//   d         = d, else 1 - Tr, else 1
//   reflect   = Ks for illum 3, 4, 5, 6, 7, 8, else 0
//   transmit  = (1 - d) * Tf; for illum 6 and 7 with d = 1: (1 - Ks) * Tf, as their formula says
//   ior       = Ni where illum asks for glass or refraction (4, 6, 7, 9), else 1: straight through
//
// glTF 2.0 (alpha = roughness^2; F0 = ((ior - 1) / (ior + 1))^2; polish = (1 - roughness)^2)
//   diffuse   = base * (1 - metallic) * (1 - transmission)
//   specular  = mix(F0, base, metallic)
//   shininess = 2 / alpha^2 - 2 in [1, 8192]: the Phong exponent whose lobe is as wide as the
//               Beckmann distribution's (Walter, Marschner, Li, Torrance 2007, "Microfacet Models
//               for Refraction through Rough Surfaces", for the Phong distribution's exponent)
//   reflect   = mix(F0 * transmission, base, metallic) * polish
//   ambient   = diffuse + base * metallic * (1 - polish): rough metal is not black in the shadow
//   transmit  = base * (1 - metallic) * transmission
//   ior       = ior (1.5 by default) if the volume has a thickness, else 1: thin, straight through
//   emissive  = emissiveFactor * emissiveStrength
//   alphaMode BLEND with alpha a: all but emissive and highlights times a, transmit + (1 - a)
//   unlit     : emissive = base, everything else 0
//   A metallic-roughness texture gives the metalness that we don't read yet: metallic is 0 then.
#pragma once

#include "tracer/scene/material.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace raypick {

struct MtlMaterial {
    std::string name;
    glm::vec3 kd{0.8f};
    glm::vec3 ks{0.0f};
    glm::vec3 ke{0.0f};
    glm::vec3 tf{1.0f};
    double ns = 32.0;
    std::optional<double> ni;
    std::optional<double> d;
    std::optional<double> tr;
    int illum = 2;
    bool textured = false;
};

struct GltfMaterial {
    std::string name;
    glm::vec3 base{1.0f};
    double alpha = 1.0;
    double metallic = 1.0;
    double roughness = 1.0;
    glm::vec3 emissive{0.0f};
    double transmission = 0.0;
    double ior = 1.5;
    double thickness = 0.0;
    bool blend = false;  // alphaMode
    bool unlit = false;
    bool metallic_texture = false;
};

Material material_from(const MtlMaterial& mtl);
Material material_from(const GltfMaterial& gltf);

}  // namespace raypick
