#include "viewer/raster/gpu_materials.h"

#include "viewer/gl/load_gl.h"

#include <glm/vec4.hpp>

#include <algorithm>

namespace raypick {

namespace {

// Below this opacity a surface is not there.
float vanishing_opacity(const Material& m) {
    return m.alpha_mode == AlphaMode::cut_out ? m.alpha_cutoff : 1.0f / 255;
}

// Bits 0..1: channel; 2: nearest; 3..4: wrap_u; 5..6: wrap_v.
int map_modes(const TextureMap& map) {
    return map.channel | (map.filter == TextureFilter::nearest ? 4 : 0) |
           static_cast<int>(map.wrap_u) << 3 | static_cast<int>(map.wrap_v) << 5;
}

glm::vec4 block_head(const Material& m) {
    int present = 0;
    for (std::size_t slot = 0; slot < kMapSlots; ++slot) {
        if (m.maps[slot]) present |= 1 << slot;
    }
    return {m.opacity, vanishing_opacity(m), m.alpha_mode == AlphaMode::blend ? 1.0f : 0.0f,
            static_cast<float>(present)};
}

void add_block(std::vector<glm::vec4>& texels, const Material& m) {
    texels.push_back(block_head(m));
    for (const TextureMap& map : m.maps) {
        texels.emplace_back(map.u_row, static_cast<float>(map ? map.texture : 0));
        texels.emplace_back(map.v_row, static_cast<float>(map_modes(map)));
        texels.emplace_back(map.base, map.gain, 0.0f, 0.0f);
    }
}

void add_material(std::vector<glm::vec4>& texels, const Material& m, int block) {
    texels.emplace_back(m.ambient, m.shininess);
    texels.emplace_back(m.diffuse, m.model == LocalModel::blinn_phong ? 1.0f : 0.0f);
    texels.emplace_back(m.specular, m.alpha_mode == AlphaMode::blend ? m.opacity : 1.0f);
    texels.emplace_back(m.emissive, static_cast<float>(block));
}

BufferTexture upload(const std::vector<glm::vec4>& texels, const char* what) {
    return {GL_RGBA32F, sizeof(glm::vec4), std::as_bytes(std::span(texels)), what};
}

}  // namespace

SurfaceLook surface_look(const Material& material) {
    const auto present = [](const TextureMap& map) { return static_cast<bool>(map); };
    SurfaceLook look;
    look.cut_out =
        present(material.map(MapSlot::opacity)) || material.opacity < vanishing_opacity(material);
    look.normal_map = present(material.map(MapSlot::normal));
    look.textured =
        look.cut_out || std::any_of(material.maps.begin(), material.maps.end(), present);
    return look;
}

GpuMaterials upload_materials(const Scene& scene) {
    GpuMaterials gpu;
    std::vector<glm::vec4> materials;
    std::vector<glm::vec4> maps;
    int blocks = 0;
    for (const Material& m : scene.materials) {
        const SurfaceLook look = surface_look(m);
        add_material(materials, m, look.textured ? blocks++ : -1);
        if (look.textured) add_block(maps, m);
        gpu.looks.push_back(look);
    }
    add_material(materials, material(scene, kNoMaterial), -1);
    gpu.materials = upload(materials, "materials");
    gpu.maps = upload(maps, "texture maps");
    return gpu;
}

}  // namespace raypick
