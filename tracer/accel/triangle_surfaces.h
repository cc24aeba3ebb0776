// Surface points on triangles, many at once.
#pragma once

#include "tracer/accel/surface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// Collects hits of meshes and works their surface points out together, as vectors of whatever width
// the processor has. What set_surface_point says, to the bit.
class TriangleSurfaces {
public:
    // Whether add() takes such hits: triangles of a mesh that nothing moves.
    [[nodiscard]] static bool takes(const HitObject& at);

    void clear() { count_ = 0; }
    // All references must be alive when the surface is worked out, into `result`.
    void add(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
             SurfacePoint& result);
    // Sets the result of each hit added since clear().
    void find(const Scene& scene);

    // One float of each hit goes into each of these rows: corners, their normals (0 where there are
    // none), the ray, t and uv.
    static constexpr std::size_t kCorners = 0;
    static constexpr std::size_t kNormals = 9;
    static constexpr std::size_t kOrigin = 18;
    static constexpr std::size_t kDirection = 21;
    static constexpr std::size_t kT = 24;
    static constexpr std::size_t kU = 25;
    static constexpr std::size_t kV = 26;
    static constexpr std::size_t kInputs = 27;
    // And comes out of each of these.
    static constexpr std::size_t kPosition = 0;
    static constexpr std::size_t kError = 3;
    static constexpr std::size_t kGeometric = 6;
    static constexpr std::size_t kShading = 9;
    static constexpr std::size_t kOutputs = 12;
    // Some hits side by side: rows of one block are always as far apart, so that all of a hit's
    // numbers are found from one place.
    static constexpr std::size_t kLanes = 16;
    struct Block {
        alignas(64) std::array<float, kInputs * kLanes> in{};
        std::array<float, kOutputs * kLanes> out{};
        std::array<double, kLanes> room{};  // > 0: far from the edges; others want a closer look
    };

private:
    struct Wanted {
        const Object* object = nullptr;
        const Transform* object_from_world = nullptr;
        MaterialId material = kNoMaterial;
        bool textured = false;
        const Ray* ray = nullptr;
        const Hit* hit = nullptr;
        SurfacePoint* result = nullptr;
    };

    static void take(const Wanted& wanted, const Block& block, std::size_t lane);
    // What textures need; `before`: of the hit before this one, null if there was none.
    static void take_uv(const Scene& scene, const Wanted& wanted, const Wanted* before);

    std::size_t count_ = 0;
    std::vector<Wanted> wanted_;  // as long as the blocks have room for
    std::vector<Block> blocks_;
};

}  // namespace raypick
