// Ends of rays with the light that falls on them, many at once.
#pragma once

#include "tracer/accel/lane_rows.h"
#include "tracer/accel/surface_rows.h"
#include "tracer/geometry/ray.h"
#include "tracer/shade/light_sample.h"
#include "tracer/shade/textured.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace raypick {

// What lit_point.h says of one point and one light, to the bit, as vectors of whatever width the
// processor has. Keeps its memory. First mirror(), if any point is to send a mirrored ray on, then
// leave_surfaces(), if any light casts shadows. Then per light: shine() on all points,
// take_shadow_rays() if it casts shadows, block() or tint() those in its way, gather().
class LitPoints {
public:
    void clear() { count_ = 0; }
    // Adds the ends of these rays, in a block of their own: its first point, lane by lane. Each
    // wants its number and its material, or to be left out.
    std::size_t add(const SurfaceRows& ends);
    // `own`: what the surface gives off by itself.
    void set_material(std::size_t i, const SurfaceMaterial& material, const glm::vec3& own);
    // The same for all points of the block that begins with this one.
    void set_materials(std::size_t first, const SurfaceMaterial& material, const glm::vec3& own);
    void set_ray(std::size_t i, std::uint32_t ray) { blocks_[i / kLanes].ray[i % kLanes] = ray; }
    // The shading normal, towards the eye.
    void set_normal(std::size_t i, const glm::vec3& normal);
    void leave_out(std::size_t i) { blocks_[i / kLanes].used &= ~(1u << (i % kLanes)); }

    // Points are numbered below this; some numbers are of none.
    [[nodiscard]] std::size_t size() const { return count_ * kLanes; }
    [[nodiscard]] bool holds(std::size_t i) const {
        return (blocks_[i / kLanes].used >> (i % kLanes) & 1u) != 0;
    }
    [[nodiscard]] std::uint32_t ray(std::size_t i) const {
        return blocks_[i / kLanes].ray[i % kLanes];
    }
    [[nodiscard]] glm::vec3 position(std::size_t i) const { return at(i, kPosition); }
    [[nodiscard]] glm::vec3 normal(std::size_t i) const { return at(i, kNormal); }

    // Works out mirrored rays of all points in blocks of 16 where one is wanted, until the first
    // light shines.
    void want_mirrored(std::size_t i) { blocks_[i / kLanes].mirrors = true; }
    void mirror();
    void take_mirrored(std::size_t i, Ray& ray) const;

    // Works out where rays to the lights begin.
    void leave_surfaces();

    // True for lights that shine on all points at once; others shine on one after the other.
    [[nodiscard]] static bool at_once(const PreparedLight& light) {
        return light.kind == PreparedLight::Kind::point ||
               light.kind == PreparedLight::Kind::directional;
    }
    void shine(const PreparedLight& light);
    void shine(std::size_t i, const LightSample& light);
    // Leaves out the points that the light doesn't reach, with shadows also those that keep it off
    // themselves. To be called once it shines on all.
    void face_light(bool shadows);

    // Towards the light from where it may arrive, points[k] being the point of rays[k]; both are as
    // long as there are points at least. Returns how many.
    [[nodiscard]] std::size_t take_shadow_rays(std::span<Ray> rays,
                                               std::span<std::uint32_t> points) const;
    void block(std::size_t i) { blocks_[i / kLanes].lit &= ~(1u << (i % kLanes)); }
    void tint(std::size_t i, const glm::vec3& share);
    // Adds the light to the points that it reaches.
    void gather();

    // All that leaves the point by itself and by the lights.
    [[nodiscard]] glm::vec3 colour(std::size_t i) const {
        return at(i, kColour) * blocks_[i / kLanes].opacity[i % kLanes];
    }

    // One float of each point is in each of these rows: of a LitPoint and its material,
    static constexpr std::size_t kPosition = 0;
    static constexpr std::size_t kOutside = 3;  // first the bounds on the position's error
    static constexpr std::size_t kNormal = 6;
    static constexpr std::size_t kGeometric = 9;
    static constexpr std::size_t kToEye = 12;
    static constexpr std::size_t kDiffuse = 15;
    static constexpr std::size_t kSpecular = 18;
    static constexpr std::size_t kShininess = 21;
    // its colour so far,
    static constexpr std::size_t kColour = 22;
    // and of the light that shines.
    static constexpr std::size_t kToLight = 25;
    static constexpr std::size_t kDistance = 28;
    static constexpr std::size_t kLight = 29;
    // Before one does, of the mirrored ray.
    static constexpr std::size_t kMirrored = 25;
    static constexpr std::size_t kMirroredOrigin = 28;
    static constexpr std::size_t kRows = 32;
    // Some points side by side.
    static constexpr std::size_t kLanes = SurfaceRows::kLanes;
    struct Block {
        alignas(64) std::array<float, kRows * kLanes> row{};
        std::array<std::uint32_t, kLanes> ray{};
        std::array<float, kLanes> opacity{};
        // Bits by point.
        std::uint32_t used = 0;  // there is one
        std::uint32_t lit = 0;
        std::uint32_t shiny = 0;  // with a highlight
        std::uint32_t blinn = 0;  // by Blinn's model
        std::uint32_t front = 0;  // seen from the front
        bool mirrors = false;     // some do
    };

private:
    [[nodiscard]] glm::vec3 at(std::size_t i, std::size_t first) const {
        return vector_at<kLanes>(&blocks_[i / kLanes].row[i % kLanes], first);
    }
    [[nodiscard]] std::span<Block> used() { return std::span(blocks_).first(count_); }
    [[nodiscard]] std::span<const Block> used() const { return std::span(blocks_).first(count_); }

    std::size_t count_ = 0;  // blocks in use
    std::vector<Block> blocks_;
};

}  // namespace raypick
