// Materials and their texture maps on the GPU.
#pragma once

#include "tracer/scene/scene.h"
#include "viewer/gl/textures.h"

#include <algorithm>
#include <vector>

namespace raypick {

// What the programs that draw a surface must know of its materials.
struct SurfaceLook {
    bool textured = false;  // the look changes over the surface, or it has holes
    bool cut_out = false;   // it has holes
    bool normal_map = false;

    SurfaceLook& operator|=(const SurfaceLook& other) {
        textured |= other.textured;
        cut_out |= other.cut_out;
        normal_map |= other.normal_map;
        return *this;
    }
};
SurfaceLook surface_look(const Material& material);

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
    std::vector<SurfaceLook> looks;  // by material id

    // Without the default.
    [[nodiscard]] int count() const { return static_cast<int>(looks.size()); }
    // Of a material of the scene or kNoMaterial.
    [[nodiscard]] SurfaceLook look(MaterialId id) const {
        return id < looks.size() ? looks[id] : SurfaceLook{};
    }
    [[nodiscard]] bool any_textured() const {
        return std::any_of(looks.begin(), looks.end(),
                           [](const SurfaceLook& look) { return look.textured; });
    }
};

GpuMaterials upload_materials(const Scene& scene);

}  // namespace raypick
