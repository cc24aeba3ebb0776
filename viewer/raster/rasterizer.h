// Draws a scene with OpenGL 3.3 so that every pixel shows what the tracer's eye ray hits there:
// same camera, same local Phong shading, same object and primitive ids, same tie rule.
#pragma once

#include "tracer/geometry/camera.h"
#include "tracer/render/image.h"
#include "tracer/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace raypick {

// Surfaces at the same t (kTieGap): `kept` gives the pixel to the lowest (object, primitive), as
// the tracer does, in two passes. `dropped` gives it to the nearest float in one pass: nearly twice
// as fast without a GPU, for frames while the camera moves. Ids and colours of all other pixels are
// the same.
enum class TieRule { kept, dropped };

// Whether the CPU looks first which triangles can be seen, and only those are drawn. The picture is
// the same. `automatic`: where the CPU draws as well, on a grid as fine as that needs (kSpotBits).
enum class Unseen { automatic, left_out, drawn };

// Needs a current OpenGL 3.3 core context with its functions loaded, the same one in every call.
class Rasterizer {
public:
    explicit Rasterizer(Unseen unseen = Unseen::automatic);
    ~Rasterizer();
    Rasterizer(const Rasterizer&) = delete;
    Rasterizer& operator=(const Rasterizer&) = delete;

    // Uploads a scene. Meshes whose arrays are on the GPU already stay there.
    void set_scene(std::shared_ptr<const Scene> scene);
    // What of the scene is shown coarser than it is, because this OpenGL can't hold all of it.
    [[nodiscard]] std::vector<std::string> warnings() const;

    // Does ahead of time, and without a scene, what draw() would do the first time for meshes
    // without textures in frames of this size: buffers, programs, their machine code.
    void warm_up(ImageSize size);

    // Draws a frame of the scene into this object's own buffers. Only objects with
    // (object.mask & mask) != 0 are drawn. camera.near clips; far is infinite.
    void draw(const Camera& camera, ImageSize size, std::uint32_t mask = 0xffffffffu,
              TieRule ties = TieRule::kept);

    // The last frame's textures: linear RGB with t in alpha (RGBA32F), and object id (R32UI,
    // kNoObject on background). Row 0 of the texture is the BOTTOM row, as OpenGL has it.
    [[nodiscard]] unsigned colour_texture() const;
    [[nodiscard]] unsigned object_texture() const;

    // The last frame, read back: colour, depth (t), normal, object and primitive; row 0 on top.
    [[nodiscard]] Image read_image() const;
    // Its colour alone, which is all that a PNG shows: the other channels stay empty.
    [[nodiscard]] Image read_colour() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace raypick
