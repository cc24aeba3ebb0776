#include "viewer/raster/shader_set.h"

#include "viewer/gl/shader_source.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

namespace raypick {

namespace {

void set_unit(const Uniforms& uniforms, const char* sampler, Unit unit) {
    uniforms.set(sampler, static_cast<int>(unit));
}

void bind_inputs(const Program& program) {
    const GLuint block = glGetUniformBlockIndex(program.name(), "View");
    if (block != GL_INVALID_INDEX) glUniformBlockBinding(program.name(), block, kViewBinding);
    const Uniforms uniforms(program);
    set_unit(uniforms, "triangles", Unit::triangles);
    set_unit(uniforms, "positions", Unit::positions);
    // Sets have these two instead of positions and triangles.
    set_unit(uniforms, "elements", Unit::positions);
    set_unit(uniforms, "element_materials", Unit::triangles);
    set_unit(uniforms, "normals", Unit::normals);
    set_unit(uniforms, "uvs", Unit::uvs);
    set_unit(uniforms, "normal_t", Unit::normal_t);
    set_unit(uniforms, "material", Unit::material);
    set_unit(uniforms, "materials", Unit::materials);
    set_unit(uniforms, "lights", Unit::lights);
    set_unit(uniforms, "maps", Unit::maps);
    set_unit(uniforms, "texture_table", Unit::texture_table);
    set_unit(uniforms, "texels", Unit::texels);
    set_unit(uniforms, "uv", Unit::uv);
    set_unit(uniforms, "footprint_axes", Unit::footprint);
    set_unit(uniforms, "sky_texels", Unit::sky_texels);
}

struct ShapeShader {
    const char* vertex_file;
    const char* define;
};
constexpr ShapeShader kShapes[kShapeKinds] = {{"mesh.vert", "SHAPE_MESH"},
                                              {"proxy.vert", "SHAPE_SPHERE"},
                                              {"proxy.vert", "SHAPE_BOX"},
                                              {"fullscreen.vert", "SHAPE_PLANE"},
                                              {"proxy.vert", "SHAPE_DISK"},
                                              {"proxy.vert", "SHAPE_RECTANGLE"},
                                              {"proxy.vert", "SHAPE_CONE"},
                                              {"proxy.vert", "SHAPE_TORUS"},
                                              {"sphere_set.vert", "SHAPE_SPHERE_SET"},
                                              {"cone_set.vert", "SHAPE_CONE_SET"}};

Program shape_program(const ShapeShader& shape, const char* fragment_file,
                      const SurfaceLook& look) {
    std::vector<std::string> defines = {shape.define};
    if (look.textured) defines.emplace_back("TEXTURED");
    if (look.cut_out) defines.emplace_back("CUT_OUT");
    if (look.normal_map) defines.emplace_back("NORMAL_MAP");
    Program program = make_program(shape.vertex_file, fragment_file, defines);
    bind_inputs(program);
    return program;
}

Program shade_program(const ShadeKind& kind) {
    std::vector<std::string> defines;
    if (kind.textured) defines.emplace_back("TEXTURED");
    if (kind.image_sky) defines.emplace_back("IMAGE_SKY");
    if (kind.shaped_lights) defines.emplace_back("SHAPED_LIGHTS");
    Program program = make_program("fullscreen.vert", "shade.frag", defines);
    bind_inputs(program);
    return program;
}

std::size_t number_of(const ShadeKind& kind) {
    return (kind.textured ? 1u : 0u) + (kind.image_sky ? 2u : 0u) + (kind.shaped_lights ? 4u : 0u);
}

ShadeKind shade_kind(std::size_t number) {
    return {(number & 1u) != 0, (number & 2u) != 0, (number & 4u) != 0};
}

std::size_t number_of(const SurfaceLook& look) {
    return (look.textured ? 1u : 0u) + (look.cut_out ? 2u : 0u) + (look.normal_map ? 4u : 0u);
}

SurfaceLook surface_look(std::size_t number) {
    return {(number & 1u) != 0, (number & 2u) != 0, (number & 4u) != 0};
}

// Where there are no holes, how far away a surface is doesn't depend on its look.
SurfaceLook look_in(Pass pass, const SurfaceLook& look) {
    if (pass == Pass::surface) return look;
    return {look.cut_out, look.cut_out, false};
}

constexpr const char* kFragmentFiles[] = {"depth.frag", "surface.frag"};  // by Pass

}  // namespace

ShaderSet::ShaderSet() {
    shade({});
}

const Program& ShaderSet::shape(Pass pass, std::size_t kind, const SurfaceLook& look) {
    const auto file = static_cast<std::size_t>(pass);
    const SurfaceLook needed = look_in(pass, look);
    Program& program = shapes_[kind][kVariants / 2 * file + number_of(needed)];
    if (!program) program = shape_program(kShapes[kind], kFragmentFiles[file], needed);
    return program;
}

const Program& ShaderSet::shade(const ShadeKind& kind) {
    Program& program = shade_[number_of(kind)];
    if (!program) program = shade_program(kind);
    return program;
}

ShaderSet ShaderSet::again() const {
    ShaderSet fresh;
    for (std::size_t i = 0; i < shade_.size(); ++i) {
        if (shade_[i]) fresh.shade(shade_kind(i));
    }
    for (std::size_t kind = 0; kind < kShapeKinds; ++kind) {
        for (std::size_t i = 0; i < kVariants; ++i) {
            if (!shapes_[kind][i]) continue;
            const auto pass = static_cast<Pass>(i / (kVariants / 2));
            fresh.shape(pass, kind, surface_look(i % (kVariants / 2)));
        }
    }
    return fresh;
}

ShaderWatch::ShaderWatch() : folder_(shader_folder()), seen_(newest()) {}

bool ShaderWatch::changed() {
    if (!folder_) return false;
    const auto now = newest();
    return now > std::exchange(seen_, now);
}

std::filesystem::file_time_type ShaderWatch::newest() const {
    auto time = std::filesystem::file_time_type::min();
    if (!folder_) return time;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(*folder_, error)) {
        time = std::max(time, entry.last_write_time(error));
    }
    return time;
}

}  // namespace raypick
