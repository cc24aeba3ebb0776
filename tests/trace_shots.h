// Single rays through small scenes, and what they bring back.
#pragma once

#include "tests/tracer_scenes.h"
#include "tracer/shade/trace.h"

#include <gtest/gtest.h>

#include <utility>

namespace raypick {

inline void expect_colour(const glm::vec3& got, const glm::dvec3& wanted, double tolerance = 1e-6) {
    EXPECT_NEAR(static_cast<double>(got.x), wanted.x, tolerance);
    EXPECT_NEAR(static_cast<double>(got.y), wanted.y, tolerance);
    EXPECT_NEAR(static_cast<double>(got.z), wanted.z, tolerance);
}

struct Shot {
    TracedRay traced;
    RayCounts counts;
};

inline Shot shoot(const Scene& scene, const Ray& ray, const RenderSettings& settings = {},
                  std::uint64_t seed = 0) {
    const Accel accel = accel_of(scene);
    Shot shot;
    shot.traced = trace(accel, scene.lights, settings, EyeRay{ray, {}, seed}, shot.counts);
    return shot;
}

// No light of its own anywhere: what a test sees it has put there.
inline Scene dark_scene() {
    Scene scene;
    scene.background = glm::vec3(0.0f);
    scene.ambient = glm::vec3(0.0f);
    return scene;
}

inline Material mirror_material(float reflect = 1.0f) {
    Material material = black_material();
    material.reflect = glm::vec3(reflect);
    return material;
}

inline Material glass_material(float ior = 1.5f) {
    Material material = black_material();
    material.transmit = glm::vec3(1.0f);
    material.ior = ior;
    return material;
}

inline Material white_material() {
    Material material = black_material();
    material.diffuse = glm::vec3(1.0f);
    return material;
}

}  // namespace raypick
