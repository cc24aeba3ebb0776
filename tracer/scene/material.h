// What a surface looks like. Colours are linear RGB.
#pragma once

#include "tracer/scene/texture.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <string>

namespace raypick {

// The highlight: (R.V)^shininess with R the mirrored light direction, or (N.H)^shininess with H
// halfway between light and eye.
enum class LocalModel { phong, blinn_phong };

// How much is reflected and transmitted. F is the unpolarised Fresnel reflectance for the angle and
// the indices on both sides.
enum class Reflectance {
    constant,    // reflect, transmit (the notes, NFF, MTL)
    dielectric,  // reflect * F, transmit * (1 - F)
    conductor,   // reflect + (1 - reflect) (1 - cos)^5 (Schlick); 0 stays 0
};

// How opacity below 1 acts.
enum class AlphaMode {
    cut_out,  // where it is below alpha_cutoff there is no surface: for picks, rays and raster
    blend,    // colour = opacity * this surface + (1 - opacity) * what lies straight behind
};

// What a texture map of a material multiplies.
enum class MapSlot : std::size_t {
    diffuse,  // also ambient, where that has no map of its own
    specular,
    shininess,  // one channel; leaves no less than 1, or than the material has
    reflect,
    transmit,
    opacity,  // one channel
    emissive,
    normal,  // tangent space, [0, 1] for [-1, 1] (glTF): x along u, y along v; gain scales x and y
    ambient,
};
inline constexpr std::size_t kMapSlots = 9;

// Phong's model with the notes' recursive terms:
//   colour = emissive + ambient * scene ambient
//          + sum over lights: light * (diffuse * max(0, N.L) + specular * max(0, R.V)^shininess)
//          + reflect * trace(reflection ray) + transmit * trace(refraction ray)
struct Material {
    std::string name;
    glm::vec3 ambient{0.8f};
    glm::vec3 diffuse{0.8f};
    glm::vec3 specular{0.0f};
    float shininess = 32.0f;
    glm::vec3 emissive{0.0f};
    glm::vec3 reflect{0.0f};
    glm::vec3 transmit{0.0f};
    float ior = 1.5f;  // index of refraction of the inside; where no other glass is, outside has 1

    LocalModel model = LocalModel::phong;
    Reflectance reflectance = Reflectance::constant;
    // Thin-walled: a sheet without an inside. Transmitted rays go straight on; a dielectric
    // reflects at both faces, 2 F / (1 + F).
    bool thin_walled = false;
    // What the inside absorbs per unit of length: exp(-absorption * distance) passes
    // (Beer-Lambert).
    glm::vec3 absorption{0.0f};
    // Of overlapping insides the higher priority is there, of equal ones what was entered
    // last. Source: Schmidt, Budge, "Simple Nested Dielectrics in Ray Traced Images", 2002.
    int priority = 0;

    float opacity = 1.0f;
    AlphaMode alpha_mode = AlphaMode::cut_out;
    float alpha_cutoff = 0.5f;

    std::array<TextureMap, kMapSlots> maps{};  // by MapSlot

    [[nodiscard]] TextureMap& map(MapSlot slot) { return maps[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] const TextureMap& map(MapSlot slot) const {
        return maps[static_cast<std::size_t>(slot)];
    }
    [[nodiscard]] bool reflects() const { return reflect != glm::vec3(0.0f); }
    [[nodiscard]] bool transmits() const { return transmit != glm::vec3(0.0f); }
};

}  // namespace raypick
