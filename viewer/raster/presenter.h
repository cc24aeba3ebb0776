// Puts a frame (rasterised or traced) on the screen: sRGB, with the selection's outline on top.
#pragma once

#include "picking/cursor.h"
#include "tracer/render/image.h"
#include "tracer/scene/scene.h"

#include <memory>
#include <span>

namespace raypick {

struct OutlineStyle {
    glm::vec3 selected{1.0f, 0.55f, 0.05f};  // sRGB
    glm::vec3 hovered{1.0f, 1.0f, 1.0f};
    float width = 2.0f;  // framebuffer pixels
};

// Needs a current OpenGL 3.3 core context, the same one in every call.
class Presenter {
public:
    Presenter();
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    // Copies a traced frame (colour and object ids) to textures of its own. `step`: each pixel of
    // the image stands for a block of so many rows and columns of the view, from its top left
    // corner on.
    void upload(const Image& image, int step = 1);
    [[nodiscard]] unsigned colour_texture() const;
    [[nodiscard]] unsigned object_texture() const;

    // Draws the textures (as Rasterizer's: bottom row first) over `view` of the bound framebuffer,
    // which is `framebuffer_rows` high. Outlines the objects in `selected`, and `hovered`
    // (kNoObject: none).
    void present(unsigned colour_texture, unsigned object_texture, const ViewRect& view,
                 int framebuffer_rows, std::span<const ObjectId> selected, ObjectId hovered,
                 const OutlineStyle& style = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace raypick
