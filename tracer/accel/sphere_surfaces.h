// Surface points on spheres, many at once.
#pragma once

#include "tracer/accel/surface.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace raypick {

// Collects hits of spheres and works their surface points out together, as vectors of whatever
// width the processor has. What set_surface_point says, to the bit.
class SphereSurfaces {
public:
    // Whether add() takes such hits: spheres that nothing moves and no texture needs.
    [[nodiscard]] static bool takes(const HitObject& at);

    void clear() { count_ = 0; }
    // `hit` and `result` must be alive when the surface is worked out, into `result`.
    void add(const Scene& scene, const HitObject& at, const Ray& ray, const Hit& hit,
             SurfacePoint& result);
    // Sets the result of each hit added since clear().
    void find();

    // One double of each hit goes into each of these rows.
    static constexpr std::size_t kOrigin = 0;
    static constexpr std::size_t kDirection = 3;
    static constexpr std::size_t kT = 6;
    static constexpr std::size_t kCentre = 7;
    static constexpr std::size_t kRadius = 10;
    static constexpr std::size_t kInputs = 11;
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

    static void take(const Wanted& wanted, const Block& block, std::size_t lane);

    std::size_t count_ = 0;
    std::vector<Wanted> wanted_;  // as long as the blocks have room for
    std::vector<Block> blocks_;
};

}  // namespace raypick
