// The hits of many rays, gathered by the kind of shape that was hit.
#pragma once

#include "tracer/accel/shape_surfaces.h"
#include "tracer/accel/surface_rows.h"
#include "tracer/accel/triangle_surfaces.h"
#include "tracer/shade/shade_scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// Hands hits on in blocks of those on the same kind of shape, with what find_surface says of each,
// to the bit: most are worked out together. First begin(), then add() for all hits, then rest()
// until there is none. Keeps its memory.
class Arrivals {
public:
    static constexpr std::size_t kLanes = SurfaceRows::kLanes;
    struct Block {
        SurfaceRows rows;
        std::array<std::uint32_t, kLanes> hit{};   // its number
        std::array<std::uint32_t, kLanes> part{};  // see part()
    };

    // The scene, the rays and their hits must be there until the last block has been handed on.
    void begin(const ShadeScene& scene, std::span<const Ray> rays, std::span<const Hit> hits);
    // Of hits from i on until one is not valid; i comes to be that one's number, or how many there
    // are. Returns the block that one fills, with i behind that one; nullptr: they have room for
    // more. Blocks are valid until the next call of any of these.
    const Block* add(std::size_t& i);
    // A block that isn't full; nullptr: there is none left.
    const Block* rest();

    // What the hit in this lane is on.
    [[nodiscard]] const KnownPart& part(const Block& block, std::size_t lane) const {
        return parts_[block.part[lane]];
    }
    // Sets what find_surface says of the hit in this lane.
    void set_found(const Block& block, std::size_t lane, FoundHit& found);

private:
    static constexpr std::size_t kKinds = 4;  // of SurfaceKind
    struct Gathered {
        Block block;
        bool handed_on = true;
    };

    std::size_t add_run(Block& block, std::size_t i);
    const Block* hand_on(SurfaceKind kind);
    void find_triangles(Block& block);
    void set_texture_uv(const KnownPart& part, const Hit& hit, SurfacePoint& surface);

    const ShadeScene* scene_ = nullptr;
    std::span<const Ray> rays_;
    std::span<const Hit> hits_;
    std::vector<KnownPart> parts_;
    std::array<Gathered, kKinds> gathered_;
    TriangleSurfaces triangles_;
    ShapeSurfaces spheres_;
    ShapeSurfaces rectangles_;
    std::array<SurfacePoint, kLanes> others_;  // what set_surface_point alone knows
    // The triangle whose derivatives were worked out last: rays side by side mostly hit the same.
    struct Derivatives {
        const Object* object = nullptr;
        std::uint32_t primitive = 0;
        glm::vec3 dpdu{0.0f};
        glm::vec3 dpdv{0.0f};
    };
    Derivatives derivatives_;
};

}  // namespace raypick
