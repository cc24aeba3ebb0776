// Surface points on spheres and rectangles, many at once.
#pragma once

#include "tracer/accel/surface.h"

#include <array>
#include <cstddef>
#include <vector>

namespace raypick {

// Collects hits of spheres and of rectangles and works their surface points out together, as
// vectors of whatever width the processor has. What set_surface_point says, to the bit.
class ShapeSurfaces {
public:
    // What add() takes: spheres and rectangles that nothing moves and no texture needs.
    enum class Kind { other, sphere, rectangle };
    [[nodiscard]] static Kind kind(const HitObject& at);

    void clear() { spheres_.count = rectangles_.count = 0; }
    // Not of the kind `other`. `hit` and `result` must be alive when the surface is worked out,
    // into `result`.
    void add(Kind kind, const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
             SurfacePoint& result);
    // Sets the result of each hit added since clear().
    void find();

    // One double of each hit goes into each of these rows: the ray, t,
    static constexpr std::size_t kOrigin = 0;
    static constexpr std::size_t kDirection = 3;
    static constexpr std::size_t kT = 6;
    // of a sphere
    static constexpr std::size_t kCentre = 7;
    static constexpr std::size_t kRadius = 10;
    // or a rectangle.
    static constexpr std::size_t kCorner = 7;
    static constexpr std::size_t kEdgeU = 10;
    static constexpr std::size_t kEdgeV = 13;
    static constexpr std::size_t kInputs = 16;
    // And a float comes out of each of these.
    static constexpr std::size_t kPosition = 0;
    static constexpr std::size_t kError = 3;
    static constexpr std::size_t kNormal = 6;
    static constexpr std::size_t kOutputs = 9;
    // Some hits side by side, as in TriangleSurfaces.
    static constexpr std::size_t kLanes = 8;
    struct Block {
        alignas(64) std::array<double, kInputs * kLanes> in{};
        std::array<float, kOutputs * kLanes> out{};
    };

private:
    struct Wanted {
        MaterialId material = kNoMaterial;
        const Hit* hit = nullptr;
        SurfacePoint* result = nullptr;
    };
    // Hits of one kind of shape.
    struct Hits {
        std::size_t count = 0;
        std::vector<Wanted> wanted;  // as long as the blocks have room for
        std::vector<Block> blocks;
    };

    static void take(const Hits& hits);
    static void take(const Wanted& wanted, const Block& block, std::size_t lane);

    Hits spheres_;
    Hits rectangles_;
};

}  // namespace raypick
