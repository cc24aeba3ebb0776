// Materials and their texture maps on the GPU.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/gl/textures.h"

#include <algorithm>
#include <vector>

namespace raypick {

// Whether a material's look changes over a surface, or whether it is cut out: its objects are drawn
// by the programs that know textures.
bool is_textured(const Material& material);

// Read by shaders/material.glsl.
struct GpuMaterials {
    // Four texels each, the default material last:
    //   0: ambient, shininess    1: diffuse, 1 if the model is Blinn-Phong
    //   2: specular, opacity if blended (else 1)    3: emissive, index of its block in maps (or -1)
    BufferTexture materials;
    // A block of 1 + 3 kMapSlots texels for each textured material:
    //   opacity, the opacity below which there is no surface, 1 if blended, bit s: has map s
    //   then for each slot: u_row, texture;   v_row, modes (map_modes);   base, gain
    BufferTexture maps;
    std::vector<bool> textured;  // by material id

    // Without the default.
    [[nodiscard]] int count() const { return static_cast<int>(textured.size()); }
    // Of a material of the scene or kNoMaterial.
    [[nodiscard]] bool is_textured(MaterialId id) const {
        return id < textured.size() && textured[id];
    }
    [[nodiscard]] bool any_textured() const {
        return std::find(textured.begin(), textured.end(), true) != textured.end();
    }
};

GpuMaterials upload_materials(const Scene& scene);

}  // namespace raypick
