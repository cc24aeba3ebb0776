#include "viewer/raster/rasterizer.h"

#include "tracer/error.h"
#include "viewer/gl/gl_row.h"
#include "viewer/gl/load_gl.h"
#include "viewer/raster/frame_buffers.h"
#include "viewer/raster/gpu_scene.h"
#include "viewer/raster/shader_set.h"
#include "viewer/raster/view_numbers.h"

#include <fmt/format.h>

#include <cstdio>

namespace raypick {

namespace {

void bind(Unit unit, GLenum target, GLuint texture) {
    bind_texture(static_cast<GLuint>(unit), target, texture);
}

// Draws one object with the program in `uniforms`, which is current.
struct ShapeDraw {
    const ViewNumbers& view;
    const DrawnObject& object;
    const Uniforms& uniforms;

    void operator()(const std::shared_ptr<const GpuMesh>& mesh) const {
        const MeshNumbers numbers =
            mesh_numbers(view, object.scene_from_object, object.object_from_scene);
        uniforms.set("clip_from_object", numbers.clip_from_object);
        uniforms.set("object_from_scene", numbers.object_from_scene);
        uniforms.set("eye_high", numbers.eye_high);
        uniforms.set("eye_low", numbers.eye_low);
        for (const GpuMesh::Chunk& chunk : mesh->chunks()) {
            uniforms.set("first_primitive", static_cast<int>(chunk.first));
            uniforms.set("has_normals", static_cast<int>(chunk.has_normals));
            bind(Unit::triangles, GL_TEXTURE_BUFFER, chunk.triangles.texture());
            bind(Unit::positions, GL_TEXTURE_BUFFER, chunk.positions.texture());
            bind(Unit::normals, GL_TEXTURE_BUFFER, chunk.normals.texture());
            glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * chunk.count));
        }
    }

    void operator()(const Sphere& sphere) const {
        const SphereNumbers numbers = sphere_numbers(view, sphere, object.object_from_scene);
        uniforms.set("object_from_scene", numbers.object_from_scene);
        uniforms.set("sphere_eye", numbers.eye);
        uniforms.set("sphere_eye_power", numbers.eye_power);
        draw_proxy();
    }

    void operator()(const Box& box) const {
        const BoxNumbers numbers = box_numbers(view, box, object.object_from_scene);
        uniforms.set("object_from_scene", numbers.object_from_scene);
        uniforms.set("box_min", numbers.min);
        uniforms.set("box_max", numbers.max);
        draw_proxy();
    }

    void operator()(const Plane& plane) const {
        const PlaneNumbers numbers = plane_numbers(view, plane, object.object_from_scene);
        uniforms.set("plane_normal", numbers.normal);
        uniforms.set("plane_height", numbers.height);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

private:
    // Back faces only: one fragment a pixel, also with the eye inside.
    void draw_proxy() const {
        const ProxyNumbers proxy = proxy_numbers(view, object.bounds);
        uniforms.set("clip_from_scene", glm::mat3(view.clip_from_scene));
        uniforms.set("proxy_min", proxy.min);
        uniforms.set("proxy_max", proxy.max);
        glEnable(GL_CULL_FACE);
        glDrawArrays(GL_TRIANGLES, 0, 36);
        glDisable(GL_CULL_FACE);
    }
};

void draw_objects(const std::array<Program, kShapeKinds>& programs, const ViewNumbers& view,
                  std::span<const DrawnObject* const> objects) {
    for (const DrawnObject* object : objects) {
        const Uniforms uniforms(programs[object->shape.index()]);
        uniforms.set("object_id", object->id);
        uniforms.set("object_material", object->material);
        std::visit(ShapeDraw{view, *object, uniforms}, object->shape);
    }
}

// What every pass wants; others (the UI) may have left something else.
void set_state() {
    for (const GLenum capability : {GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE, GL_DEPTH_TEST,
                                    GL_STENCIL_TEST, GL_FRAMEBUFFER_SRGB, GL_PRIMITIVE_RESTART}) {
        glDisable(capability);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthRange(0.0, 1.0);
    glStencilMask(0xff);
    glCullFace(GL_FRONT);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

template <typename T>
std::vector<T> read_texture(GLuint texture, ImageSize size, GLenum format, GLenum type) {
    std::vector<T> texels(size.pixel_count());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexImage(GL_TEXTURE_2D, 0, format, type, texels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    return texels;
}

}  // namespace

struct Rasterizer::State {
    ShaderSet shaders = make_shader_set();
    ShaderWatch watch;
    Buffer view_block = new_buffer();
    VertexArray no_vertices = new_vertex_array();
    GpuScene scene;
    FrameBuffers frame;

    void reload_changed_shaders();
    void depth_pass(const ViewNumbers& view, std::span<const DrawnObject* const> objects) const;
    void surface_pass(const ViewNumbers& view, std::span<const DrawnObject* const> objects,
                      TieRule ties) const;
    void shade_pass(const Camera& camera, const ViewNumbers& view) const;
};

void Rasterizer::State::reload_changed_shaders() {
    if (!watch.changed()) return;
    try {
        shaders = make_shader_set();
    } catch (const Error& error) {
        fmt::print(stderr, "raypick: {}\n", error.what());  // the developer's; the old ones stay
    }
}

void Rasterizer::State::depth_pass(const ViewNumbers& view,
                                   std::span<const DrawnObject* const> objects) const {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.depth.name());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    draw_objects(shaders.depth, view, objects);
}

void Rasterizer::State::surface_pass(const ViewNumbers& view,
                                     std::span<const DrawnObject* const> objects,
                                     TieRule ties) const {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.surface.name());
    glEnable(GL_DEPTH_TEST);
    if (ties == TieRule::kept) {
        // The first one within the gap of the depth that the first pass left takes the pixel.
        glDepthFunc(GL_LEQUAL);
        glDepthMask(GL_FALSE);
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_EQUAL, 0, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    } else {
        glDepthFunc(GL_LESS);
    }
    draw_objects(shaders.surface, view, objects);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
}

void Rasterizer::State::shade_pass(const Camera& camera, const ViewNumbers& view) const {
    const GpuLights lights = upload_lights(effective_lights(*scene.scene, camera), view.eye);
    glBindFramebuffer(GL_FRAMEBUFFER, frame.colour.name());
    bind(Unit::normal_t, GL_TEXTURE_2D, frame.normal_t.name());
    bind(Unit::material, GL_TEXTURE_2D, frame.material.name());
    bind(Unit::materials, GL_TEXTURE_BUFFER, scene.materials.texture());
    bind(Unit::lights, GL_TEXTURE_BUFFER, lights.texels.texture());
    const Uniforms uniforms(shaders.shade);
    uniforms.set("material_count", static_cast<int>(scene.scene->materials.size()));
    uniforms.set("light_count", lights.count);
    uniforms.set("ambient", scene.scene->ambient);
    uniforms.set("background", scene.scene->background);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

Rasterizer::Rasterizer() : state_(std::make_unique<State>()) {}

Rasterizer::~Rasterizer() = default;

void Rasterizer::set_scene(std::shared_ptr<const Scene> scene) {
    state_->scene = upload_scene(std::move(scene), state_->scene);
}

void Rasterizer::draw(const Camera& camera, ImageSize size, std::uint32_t mask, TieRule ties) {
    if (state_->scene.scene == nullptr) throw Error("there is no scene to draw");
    const KeepFramebuffer keep;
    state_->reload_changed_shaders();
    if (state_->frame.size != size) state_->frame = FrameBuffers(size);
    set_state();
    const ViewNumbers view = view_numbers(camera, size);
    glBindBuffer(GL_UNIFORM_BUFFER, state_->view_block.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(ViewBlock), &view.block, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, state_->view_block.name());
    std::vector<const DrawnObject*> objects;
    for (const DrawnObject& object : state_->scene.objects) {
        if ((object.mask & mask) != 0 && may_be_seen(view, object.bounds)) {
            objects.push_back(&object);
        }
    }
    glViewport(0, 0, size.cols, size.rows);
    glBindVertexArray(state_->no_vertices.name());
    state_->frame.clear();
    if (ties == TieRule::kept) state_->depth_pass(view, objects);
    state_->surface_pass(view, objects, ties);
    state_->shade_pass(camera, view);
    glBindVertexArray(0);
    glUseProgram(0);
    glActiveTexture(GL_TEXTURE0);
    check_gl("drawing the scene");
}

unsigned Rasterizer::colour_texture() const {
    return state_->frame.colour_t.name();
}

unsigned Rasterizer::object_texture() const {
    return state_->frame.object.name();
}

Image Rasterizer::read_image() const {
    const FrameBuffers& frame = state_->frame;
    const auto colour_t =
        read_texture<glm::vec4>(frame.colour_t.name(), frame.size, GL_RGBA, GL_FLOAT);
    const auto normal_t =
        read_texture<glm::vec4>(frame.normal_t.name(), frame.size, GL_RGBA, GL_FLOAT);
    const auto object = read_texture<std::uint32_t>(frame.object.name(), frame.size, GL_RED_INTEGER,
                                                    GL_UNSIGNED_INT);
    const auto primitive = read_texture<std::uint32_t>(frame.primitive.name(), frame.size,
                                                       GL_RED_INTEGER, GL_UNSIGNED_INT);
    check_gl("reading the frame");
    Image image = make_image(frame.size);
    for (int row = 0; row < frame.size.rows; ++row) {
        for (int col = 0; col < frame.size.cols; ++col) {
            const std::size_t to = frame.size.index({row, col});
            const std::size_t from = frame.size.index({gl_row(frame.size, row), col});
            image.colour[to] = glm::vec3(colour_t[from]);
            image.depth[to] = normal_t[from].w;
            image.normal[to] = glm::vec3(normal_t[from]);
            image.object[to] = object[from];
            image.primitive[to] = primitive[from];
        }
    }
    return image;
}

}  // namespace raypick
