#include "viewer/raster/shader_set.h"

#include "viewer/gl/shader_source.h"

#include <algorithm>
#include <string>
#include <system_error>

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
    set_unit(uniforms, "normals", Unit::normals);
    set_unit(uniforms, "normal_t", Unit::normal_t);
    set_unit(uniforms, "material", Unit::material);
    set_unit(uniforms, "materials", Unit::materials);
    set_unit(uniforms, "lights", Unit::lights);
}

struct ShapeShader {
    const char* vertex_file;
    const char* define;
};
constexpr ShapeShader kShapes[kShapeKinds] = {{"mesh.vert", "SHAPE_MESH"},
                                              {"proxy.vert", "SHAPE_SPHERE"},
                                              {"proxy.vert", "SHAPE_BOX"},
                                              {"fullscreen.vert", "SHAPE_PLANE"}};

Program shape_program(const ShapeShader& shape, const char* fragment_file) {
    const std::string defines[] = {shape.define};
    Program program = make_program(shape.vertex_file, fragment_file, defines);
    bind_inputs(program);
    return program;
}

}  // namespace

ShaderSet make_shader_set() {
    ShaderSet set;
    for (std::size_t i = 0; i < kShapeKinds; ++i) {
        set.depth[i] = shape_program(kShapes[i], "depth.frag");
        set.surface[i] = shape_program(kShapes[i], "surface.frag");
    }
    set.shade = make_program("fullscreen.vert", "shade.frag");
    bind_inputs(set.shade);
    return set;
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
