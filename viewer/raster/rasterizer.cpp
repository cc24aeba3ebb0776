#include "viewer/raster/rasterizer.h"

#include "tracer/error.h"
#include "viewer/gl/gl_row.h"
#include "viewer/gl/load_gl.h"
#include "viewer/raster/draw_objects.h"
#include "viewer/raster/frame_buffers.h"
#include "viewer/raster/gpu_lights.h"
#include "viewer/raster/gpu_scene.h"
#include "viewer/raster/shader_set.h"
#include "viewer/raster/spots.h"
#include "viewer/raster/view_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <utility>

namespace raypick {

namespace {

// What every pass wants; others (the UI) may have left something else.
void set_state() {
    for (const GLenum capability : std::initializer_list<GLenum>{
             GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE, GL_DEPTH_TEST, GL_STENCIL_TEST,
             GL_FRAMEBUFFER_SRGB, GL_PRIMITIVE_RESTART}) {
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

// What the second pass leaves in the stencil, so that the third looks textures up only where there
// are some: software OpenGL runs every branch of an if.
constexpr GLint kTaken = 1;     // the pixel shows something
constexpr GLint kTextured = 2;  // of an object with textures

template <typename T>
std::unique_ptr<T[]> read_texture(GLuint texture, ImageSize size, GLenum format, GLenum type) {
    auto texels = std::make_unique_for_overwrite<T[]>(size.pixel_count());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexImage(GL_TEXTURE_2D, 0, format, type, texels.get());
    glBindTexture(GL_TEXTURE_2D, 0);
    return texels;
}

}  // namespace

struct Rasterizer::State {
    ShaderSet shaders;
    ShaderWatch watch;
    Buffer view_block = new_buffer();
    VertexArray no_vertices = new_vertex_array();
    Buffer indices = new_buffer();
    bool leaves_out_unseen = false;
    GpuScene scene;
    FrameBuffers frame;

    void reload_changed_shaders();
    void depth_pass(const ViewNumbers& view, std::span<const SeenObject> objects);
    void surface_pass(const ViewNumbers& view, std::span<const SeenObject> objects, TieRule ties);
    void shade_pass(const GpuLights& lights);
    void shade_pixels(const GpuLights& lights, bool textured);
    void bind_materials() const;
    void upload_indices(const std::vector<std::uint32_t>& values) const;
    // All passes of a frame, into the lower left corner of the buffers.
    void draw(const Camera& camera, ImageSize size, std::uint32_t mask, TieRule ties);
};

void Rasterizer::State::reload_changed_shaders() {
    if (!watch.changed()) return;
    try {
        shaders = shaders.again();
    } catch (const Error& error) {
        fmt::print(stderr, "raypick: {}\n", error.what());  // the developer's; the old ones stay
    }
}

void Rasterizer::State::depth_pass(const ViewNumbers& view, std::span<const SeenObject> objects) {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.depth.name());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    draw_objects(shaders, Pass::depth, view, objects, scene.materials.count());
}

void Rasterizer::State::surface_pass(const ViewNumbers& view, std::span<const SeenObject> objects,
                                     TieRule ties) {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.surface.name());
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    const bool kept = ties == TieRule::kept;
    // The first one within the gap of the depth that the first pass left takes the pixel.
    glDepthFunc(kept ? GL_LEQUAL : GL_LESS);
    glDepthMask(kept ? GL_FALSE : GL_TRUE);
    while (!objects.empty()) {
        const bool textured = objects[0].object->look.textured;
        const auto end = std::find_if(objects.begin(), objects.end(), [&](const SeenObject& other) {
            return other.object->look.textured != textured;
        });
        const auto alike = objects.first(static_cast<std::size_t>(end - objects.begin()));
        glStencilFunc(kept ? GL_NOTEQUAL : GL_ALWAYS, kTaken | (textured ? kTextured : 0), kTaken);
        draw_objects(shaders, Pass::surface, view, alike, scene.materials.count());
        objects = objects.subspan(alike.size());
    }
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_STENCIL_TEST);
    glDepthMask(GL_TRUE);
}

// What every pass of a textured scene reads.
void Rasterizer::State::bind_materials() const {
    bind(Unit::materials, GL_TEXTURE_BUFFER, scene.materials.materials.texture());
    bind(Unit::maps, GL_TEXTURE_BUFFER, scene.materials.maps.texture());
    bind(Unit::texture_table, GL_TEXTURE_BUFFER, scene.textures->table.texture());
    bind(Unit::texels, GL_TEXTURE_BUFFER, scene.textures->texels.texture());
}

// For the vertex array that is bound.
void Rasterizer::State::upload_indices(const std::vector<std::uint32_t>& values) const {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                 GL_STREAM_DRAW);
}

void Rasterizer::State::shade_pass(const GpuLights& lights) {
    glBindFramebuffer(GL_FRAMEBUFFER, frame.colour.name());
    bind(Unit::normal_t, GL_TEXTURE_2D, frame.normal_t.name());
    bind(Unit::material, GL_TEXTURE_2D, frame.material.name());
    bind(Unit::lights, GL_TEXTURE_BUFFER, lights.texels.texture());
    bind(Unit::sky_texels, GL_TEXTURE_BUFFER, scene.sky->texels.texture());
    glEnable(GL_STENCIL_TEST);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glStencilFunc(GL_EQUAL, 0, kTextured);
    shade_pixels(lights, false);
    if (frame.textured) {
        bind(Unit::uv, GL_TEXTURE_2D, frame.uv.name());
        bind(Unit::footprint, GL_TEXTURE_2D, frame.footprint.name());
        glStencilFunc(GL_EQUAL, kTextured, kTextured);
        shade_pixels(lights, true);
    }
    glDisable(GL_STENCIL_TEST);
}

// Those that the stencil lets through.
void Rasterizer::State::shade_pixels(const GpuLights& lights, bool textured) {
    const ShadeKind kind{textured, std::holds_alternative<ImageSky>(scene.scene->environment),
                         lights.shaped};
    const Uniforms uniforms(shaders.shade(kind));
    uniforms.set("material_count", scene.materials.count());
    uniforms.set("light_count", lights.count);
    uniforms.set("ambient", scene.scene->ambient);
    set_sky(uniforms, *scene.scene, *scene.sky);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

Rasterizer::Rasterizer(Unseen unseen) : state_(std::make_unique<State>()) {
    GLint subpixel_bits = 0;
    glGetIntegerv(GL_SUBPIXEL_BITS, &subpixel_bits);
    const bool pays = draws_in_software() && subpixel_bits >= kSpotBits;
    state_->leaves_out_unseen = unseen == Unseen::left_out || (unseen == Unseen::automatic && pays);
}

Rasterizer::~Rasterizer() = default;

void Rasterizer::set_scene(std::shared_ptr<const Scene> scene) {
    state_->scene = upload_scene(std::move(scene), state_->scene);
}

std::vector<std::string> Rasterizer::warnings() const {
    std::vector<std::string> warnings;
    if (state_->scene.scene == nullptr) return warnings;
    for (const std::string& warning :
         {state_->scene.textures->warning, state_->scene.sky->warning}) {
        if (!warning.empty()) warnings.push_back(warning);
    }
    return warnings;
}

void Rasterizer::State::draw(const Camera& camera, ImageSize size, std::uint32_t mask,
                             TieRule ties) {
    set_state();
    const ViewNumbers view = view_numbers(camera, size);
    glBindBuffer(GL_UNIFORM_BUFFER, view_block.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(ViewBlock), &view.block, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, view_block.name());
    SeenObjects seen = seen_objects(scene, view, mask);
    if (leaves_out_unseen) leave_out_unseen(seen, view, size);
    // Whatever makes a texture binds it to the active unit: before the units have what is drawn
    // with.
    const GpuLights lights = upload_lights(effective_lights(*scene.scene, camera), view.eye);
    glViewport(0, 0, size.cols, size.rows);
    glBindVertexArray(no_vertices.name());
    upload_indices(seen.indices);
    frame.clear();
    bind_materials();
    if (ties == TieRule::kept) depth_pass(view, seen.objects);
    surface_pass(view, seen.objects, ties);
    shade_pass(lights);
    glBindVertexArray(0);
    glUseProgram(0);
    glActiveTexture(GL_TEXTURE0);
    check_gl("drawing the scene");
}

void Rasterizer::warm_up(ImageSize size) {
    const KeepFramebuffer keep;
    auto scene = std::make_shared<Scene>();
    MeshData data;
    data.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    data.normals.assign(3, glm::vec3(0.0f, 0.0f, 1.0f));
    data.triangles = {glm::uvec3(0, 1, 2)};
    Object object;
    object.shape = MeshInstance{add_mesh(*scene, make_mesh("triangle", std::move(data)))};
    add_object(*scene, std::move(object));
    GpuScene before = std::exchange(state_->scene, upload_scene(scene, {}));
    state_->frame = FrameBuffers(size, false);
    Camera camera;
    camera.eye = {0.2, 0.2, 1.0};
    camera.at = {0.2, 0.2, 0.0};
    state_->draw(camera, {1, 1}, 0xffffffffu, TieRule::kept);
    state_->scene = std::move(before);
}

void Rasterizer::draw(const Camera& camera, ImageSize size, std::uint32_t mask, TieRule ties) {
    if (state_->scene.scene == nullptr) throw Error("there is no scene to draw");
    const KeepFramebuffer keep;
    state_->reload_changed_shaders();
    const bool textured = state_->scene.materials.any_textured();
    if (state_->frame.size != size || (state_->frame.textured && !textured)) {
        state_->frame = FrameBuffers(size, textured);
    } else if (textured && !state_->frame.textured) {
        state_->frame.add_texture_targets();
    }
    state_->draw(camera, size, mask, ties);
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

Image Rasterizer::read_colour() const {
    const FrameBuffers& frame = state_->frame;
    const auto colour_t =
        read_texture<glm::vec4>(frame.colour_t.name(), frame.size, GL_RGBA, GL_FLOAT);
    check_gl("reading the frame");
    Image image;
    image.size = frame.size;
    image.colour.reserve(frame.size.pixel_count());
    for (int row = 0; row < frame.size.rows; ++row) {
        const glm::vec4* from = &colour_t[frame.size.index({gl_row(frame.size, row), 0})];
        image.colour.insert(image.colour.end(), from, from + frame.size.cols);
    }
    return image;
}

}  // namespace raypick
