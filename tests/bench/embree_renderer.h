// An ordinary recursive Whitted renderer on Embree, as its tutorials are written: one ray at a
// time, floats, threads over tiles. The same lights, materials and rules as ours.
#pragma once

#include "tests/bench/embree_scene.h"
#include "tracer/geometry/camera.h"
#include "tracer/shade/settings.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

#ifdef RAYPICK_HAS_EMBREE

namespace raypick::bench {

// A material as the renderer uses it. Maps are looked up by our texture code, without filtering
// over a pixel; normal maps are left out.
struct Look {
    const Material* material = nullptr;
    bool mapped = false;  // some map beside the normal's
    bool mirrors = false;
    bool transmits = false;
};

// What shading needs to know of one geometry of the scene.
struct Surface {
    const Mesh* mesh = nullptr;  // null: Embree's normal is the one
    glm::mat3 normal_from_object{1.0f};
    bool is_instance = false;          // Embree's normals are in object space
    std::vector<std::uint32_t> looks;  // of each primitive, or one of all
};

struct Lamp {
    glm::vec3 position{0.0f};  // or, if it is far away, the unit direction to it
    glm::vec3 colour{0.0f};
    glm::vec3 fade{1.0f, 0.0f, 0.0f};  // constant, linear, quadratic
    bool far_away = false;
};

class EmbreeRenderer {
public:
    // Throws std::invalid_argument for lights and cameras that it doesn't know: all but point and
    // directional lights, perspective cameras.
    EmbreeRenderer(std::shared_ptr<const EmbreeScene> scene, const Camera& camera);

    // Rows from top to bottom, linear colour.
    [[nodiscard]] std::vector<glm::vec3> render(ImageSize size, const RenderSettings& settings,
                                                int threads) const;

    [[nodiscard]] const EmbreeScene& scene() const { return *scene_; }
    [[nodiscard]] const Scene& source() const { return scene_->source(); }
    [[nodiscard]] const std::vector<Look>& looks() const { return looks_; }
    [[nodiscard]] const std::vector<Surface>& surfaces() const { return surfaces_; }
    [[nodiscard]] const std::vector<Lamp>& lamps() const { return lamps_; }
    // How far from a surface rays begin that leave it.
    [[nodiscard]] float gap() const { return gap_; }

private:
    void add_surface(const Object& object);

    std::shared_ptr<const EmbreeScene> scene_;
    Camera camera_;
    std::vector<Look> looks_;        // by material id; the last is of what has no material
    std::vector<Surface> surfaces_;  // by object index
    std::vector<Lamp> lamps_;
    float gap_ = 0.0f;
};

}  // namespace raypick::bench

#endif
