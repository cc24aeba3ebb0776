#include "viewer/raster/presenter.h"

#include "viewer/gl/gl_row.h"
#include "viewer/gl/load_gl.h"
#include "viewer/gl/program.h"
#include "viewer/gl/textures.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

namespace raypick {

namespace {

enum class PresentedUnit : GLuint { colour, object, selected };

// Rows in OpenGL's order.
template <typename T>
std::vector<T> bottom_first(const std::vector<T>& pixels, ImageSize size) {
    std::vector<T> result(pixels.size());
    for (int row = 0; row < size.rows; ++row) {
        const auto from = pixels.begin() + static_cast<std::ptrdiff_t>(size.index({row, 0}));
        const auto to =
            result.begin() + static_cast<std::ptrdiff_t>(size.index({gl_row(size, row), 0}));
        std::copy(from, from + size.cols, to);
    }
    return result;
}

ImageSize texture_size(GLuint texture) {
    ImageSize size;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &size.cols);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &size.rows);
    return size;
}

BufferTexture upload_ids(std::span<const ObjectId> selected) {
    std::vector<ObjectId> ids(selected.begin(), selected.end());
    std::sort(ids.begin(), ids.end());
    return {GL_R32UI, sizeof(ObjectId), std::as_bytes(std::span<const ObjectId>(ids)),
            "selected objects"};
}

Program make_present_program(std::span<const std::string> defines) {
    Program program = make_program("fullscreen.vert", "present.frag", defines);
    const Uniforms uniforms(program);
    uniforms.set("colour", static_cast<int>(PresentedUnit::colour));
    uniforms.set("object", static_cast<int>(PresentedUnit::object));
    uniforms.set("selected", static_cast<int>(PresentedUnit::selected));
    glUseProgram(0);
    return program;
}

void set_quad_state() {
    for (const GLenum capability :
         std::initializer_list<GLenum>{GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE, GL_DEPTH_TEST,
                                       GL_STENCIL_TEST, GL_FRAMEBUFFER_SRGB}) {
        glDisable(capability);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace

struct Presenter::State {
    Program plain = make_present_program({});
    Program outlined;  // made when it is needed first
    VertexArray no_vertices = new_vertex_array();
    GlTexture colour;
    GlTexture object;
    int step = 1;

    const Program& program(bool outlines) {
        if (!outlines) return plain;
        const std::string defines[] = {"OUTLINES"};
        if (outlined.name() == 0) outlined = make_present_program(defines);
        return outlined;
    }
};

Presenter::Presenter() : state_(std::make_unique<State>()) {}

Presenter::~Presenter() = default;

void Presenter::upload(const Image& image, int step) {
    state_->step = step;
    state_->colour =
        make_texture(kRgb32f, image.size, bottom_first(image.colour, image.size).data());
    state_->object =
        make_texture(kR32ui, image.size, bottom_first(image.object, image.size).data());
    glBindTexture(GL_TEXTURE_2D, 0);
    check_gl("uploading a traced frame");
}

unsigned Presenter::colour_texture() const {
    return state_->colour.name();
}

unsigned Presenter::object_texture() const {
    return state_->object.name();
}

void Presenter::present(unsigned colour_texture, unsigned object_texture, const ViewRect& view,
                        int framebuffer_rows, std::span<const ObjectId> selected, ObjectId hovered,
                        const OutlineStyle& style) {
    if (view.size.rows <= 0 || view.size.cols <= 0 || colour_texture == 0) return;
    set_quad_state();
    // The view's bottom row, counted from the framebuffer's bottom.
    const ImageSize framebuffer{framebuffer_rows, view.top_left.col + view.size.cols};
    const int bottom = gl_row(framebuffer, view.top_left.row + view.size.rows - 1);
    glViewport(view.top_left.col, bottom, view.size.cols, view.size.rows);
    const BufferTexture ids = upload_ids(selected);
    glActiveTexture(GL_TEXTURE0);
    const ImageSize frame = texture_size(colour_texture);
    bind_texture(static_cast<GLuint>(PresentedUnit::colour), GL_TEXTURE_2D, colour_texture);
    bind_texture(static_cast<GLuint>(PresentedUnit::object), GL_TEXTURE_2D, object_texture);
    bind_texture(static_cast<GLuint>(PresentedUnit::selected), GL_TEXTURE_BUFFER, ids.texture());
    const bool outlines = !selected.empty() || hovered != kNoObject;
    const Uniforms uniforms(state_->program(outlines));
    uniforms.set("frame_size", glm::ivec2(frame.cols, frame.rows));
    uniforms.set("view_origin", glm::vec2(view.top_left.col, bottom));
    const bool coarse = colour_texture == state_->colour.name() && state_->step > 1;
    uniforms.set("block", coarse ? state_->step : 0);
    uniforms.set("view_size", glm::vec2(view.size.cols, view.size.rows));
    uniforms.set("selected_count", static_cast<int>(selected.size()));
    uniforms.set("hovered", hovered);
    uniforms.set("selected_colour", style.selected);
    uniforms.set("hovered_colour", style.hovered);
    uniforms.set("outline_width", std::clamp(style.width, 0.0f, 32.0f));
    glBindVertexArray(state_->no_vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glUseProgram(0);
    glActiveTexture(GL_TEXTURE0);
    check_gl("presenting a frame");
}

}  // namespace raypick
