// What other formats say of a surface, said in our Material. The whole mapping stands here.
//
// Colours in MTL and glTF files are taken as linear RGB, as glTF says, those in images as sRGB;
// base stands for baseColorFactor.
//
// MTL (Wavefront; the later physically based keywords are not read)
//   diffuse   = Kd * d                  ambient = diffuse (Ka is nearly always left at 1 or 0)
//   specular  = Ks, none for illum 0 and 1          shininess = Ns in [1, 8192]
//   emissive  = Ke
//   d         = d, else 1 - Tr, else 1
//   reflect   = Ks for illum 3, 4, 5, 6, 7, 8, else 0
//   transmit  = (1 - d) * Tf; for illum 6 and 7 with d = 1: (1 - Ks) * Tf, as their formula says
//   ior       = Ni where illum asks for glass or refraction (4, 6, 7, 9), else 1: straight through
//   Fresnel   : illum 5 conductor, illum 7 dielectric, else constant
//   map_Kd, map_Ks, map_Ke, map_Ns multiply theirs; a colour that is mapped and not given, or given
//               as black, is white: many programs write Kd 0 0 0 where map_Kd says it all
//   map_d, map_Tr (1 - texel): opacity = d instead of transmit and diffuse above; cut out if nearly
//               all of the map is 0 or 1, else blended. Without them the alpha of map_Kd acts so
//   map_bump, bump, norm: normals; -bm and the heights of a map_bump as in normals_of_heights
//
// glTF 2.0 (alpha = roughness^2; polish = (1 - roughness)^2; tint = specularFactor * specularColor;
// F0 = min(1, ((ior - 1) / (ior + 1))^2 * tint))
//   diffuse   = base * (1 - metallic) * (1 - transmission)
//   specular  = mix(F0, base, metallic)
//   shininess = 2 / alpha^2 - 2 in [1, 8192]: the Phong exponent whose lobe is as wide as the
//               Beckmann distribution's (Walter, Marschner, Li, Torrance 2007, "Microfacet Models
//               for Refraction through Rough Surfaces", for the Phong distribution's exponent)
//   reflect   = mix(min(1, tint) * transmission, base, metallic) * polish
//   ambient   = diffuse + base * metallic * (1 - polish): rough metal is not black in the shadow
//   transmit  = base * (1 - metallic) * transmission
//   Fresnel   : dielectric where anything is transmitted, else conductor where anything is
//               reflected: opaque plastic has highlights but mirrors nothing
//   ior       = ior (1.5 by default); a volume without thickness is thin-walled: straight through
//   absorption = -ln(attenuationColor) / attenuationDistance inside a volume with thickness
//   emissive  = emissiveFactor * emissiveStrength
//   alphaMode : MASK cuts out below alphaCutoff, BLEND blends by alpha, OPAQUE ignores it
//   unlit     : emissive = base, everything else 0
// Textures multiply base, metallic, roughness and transmission: where the terms above are no
// product with the base texture, they are worked out for each texel (gltf_textures.h). Occlusion is
// not shown: the tracer casts shadows.
#pragma once

#include "tracer/io/mtl_map.h"
#include "tracer/io/texture_library.h"
#include "tracer/scene/material.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace raypick {

struct MtlMaterial {
    std::string name;
    std::optional<glm::vec3> kd;
    std::optional<glm::vec3> ks;
    std::optional<glm::vec3> ke;
    glm::vec3 tf{1.0f};
    double ns = 32.0;
    std::optional<double> ni;
    std::optional<double> d;
    std::optional<double> tr;
    int illum = 2;
    std::vector<MtlMap> maps;  // one of a kind at most

    [[nodiscard]] bool has_map(MtlMapKind kind) const;
    void set_map(MtlMap map);  // replaces one of the same kind
};

// What the colour terms of a glTF material come from, at one point.
struct PbrValues {
    glm::vec3 base{1.0f};
    float metallic = 1.0f;
    float roughness = 1.0f;
    float transmission = 0.0f;
    glm::vec3 f0{0.04f};
    glm::vec3 tint{1.0f};
};

struct PhongTerms {
    glm::vec3 diffuse{0.0f};
    glm::vec3 ambient{0.0f};
    glm::vec3 specular{0.0f};
    float shininess = 1.0f;
    glm::vec3 reflect{0.0f};
    glm::vec3 transmit{0.0f};
};
PhongTerms phong_terms(const PbrValues& pbr);

// A use of an image. `use` has everything but the texture.
struct GltfMap {
    ImageSource image;
    TextureMap use;
    int uv_set = 0;  // TEXCOORD_n
};

struct GltfMaterial {
    std::string name;
    PbrValues pbr;
    glm::vec3 emissive{0.0f};
    float alpha = 1.0f;
    float alpha_cutoff = 0.5f;
    bool masked = false;  // alphaMode
    bool blend = false;
    bool unlit = false;
    double ior = 1.5;
    double thickness = 0.0;
    glm::vec3 absorption{0.0f};

    std::optional<GltfMap> base_map;
    std::optional<GltfMap> metallic_roughness_map;
    std::optional<GltfMap> transmission_map;
    std::optional<GltfMap> normal_map;
    std::optional<GltfMap> emissive_map;

    // The set of texture coordinates that meshes take: that of the base colour, else of the first
    // map there is.
    [[nodiscard]] int uv_set() const;
};

Material material_from(const MtlMaterial& mtl);
// Without the maps.
Material material_from(const GltfMaterial& gltf);

}  // namespace raypick
