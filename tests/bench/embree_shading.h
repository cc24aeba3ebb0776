// The recursion of the renderer on Embree.
#pragma once

#include "tests/bench/embree_renderer.h"

#ifdef RAYPICK_HAS_EMBREE

#include "tracer/shade/textured.h"

#include <optional>

namespace raypick::bench {

// For one thread.
class EmbreeShading {
public:
    EmbreeShading(const EmbreeRenderer& renderer, const RenderSettings& settings);

    // The colour along a ray.
    glm::vec3 eye_ray(const Ray& ray) { return follow(ray, 1.0f, 1); }

private:
    // Where a ray has met something; normals on the ray's side.
    struct Point {
        glm::vec3 position{0.0f};
        glm::vec3 incoming{0.0f};
        glm::vec3 geometric{0.0f};
        glm::vec3 normal{0.0f};
        bool front_face = true;
        const Look* look = nullptr;
        SurfaceMaterial material;  // after maps
    };
    struct Split {
        glm::vec3 mirrored{0.0f};
        glm::vec3 transmitted{0.0f};
        std::optional<glm::vec3> through;
    };

    glm::vec3 follow(const Ray& ray, float weight, int depth);
    [[nodiscard]] Point point_of(const Ray& ray, const RTCRayHit& query) const;
    void find_normals(Point& point, const Surface& surface, const RTCHit& hit) const;
    [[nodiscard]] SurfaceMaterial mapped(const Look& look, const Surface& surface,
                                         const RTCHit& hit) const;
    glm::vec3 shade(const Point& point, float weight, int depth);
    [[nodiscard]] Split split_at(const Point& point) const;
    glm::vec3 lit(const Point& point);
    glm::vec3 lit_by(const Point& point, const Lamp& lamp);
    bool blocked(const Point& point, const glm::vec3& direction, float distance);
    glm::vec3 further(const Point& point, const glm::vec3& direction, const glm::vec3& share,
                      float weight, int depth);

    const EmbreeRenderer& renderer_;
    const RenderSettings& settings_;
    RTCScene scene_;
    RTCIntersectContext context_{};
};

}  // namespace raypick::bench

#endif
