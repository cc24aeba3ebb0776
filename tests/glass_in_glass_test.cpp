// Light through and from glass in glass, by hand: what is not held against POV-Ray's pictures
// (povray_oracle_test), for POV-Ray 3.7 gets it wrong.
#include "tests/looks.h"
#include "tests/tracer_scenes.h"
#include "tracer/shade/trace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace raypick {
namespace {

// What arrives at (0, -9, 0) from straight above.
float from_above(const Scene& scene, int depth) {
    RenderSettings settings;
    settings.depth = depth;
    settings.cutoff = 0.0f;
    RayCounts counts;
    const Accel accel = accel_of(scene);
    return trace(accel, scene.lights, settings, ray_towards({0, -9, 0}, {0, 0, 0}), counts)
        .colour.x;
}

// Reflectance at right angles: ((a - b) / (a + b))^2.
double reflected(double a, double b) {
    const double root = (a - b) / (a + b);
    return root * root;
}

GradientSky half_white(float above, float below) {
    GradientSky sky;
    sky.zenith = glm::vec3(above);
    sky.ground = glm::vec3(below);
    return sky;
}

// Through a ball in a ball: each of the four surfaces reflects its part.
TEST(GlassInGlass, EachSurfaceReflects) {
    Scene scene;
    scene.environment = half_white(1.0f, 0.0f);
    place(scene, Sphere{{0, 0, 0}, 2.0}, add_material(scene, glass(1.3f, Reflectance::dielectric)));
    place(scene, Sphere{{0, 0, 0}, 1.0}, add_material(scene, glass(2.0f, Reflectance::dielectric)));
    const double once = (1.0 - reflected(1.0, 1.3)) * (1.0 - reflected(1.3, 2.0));
    EXPECT_NEAR(from_above(scene, 5), once * once, 1e-5);
}

// A ball mirrors the light from below at its near side and, after twice the way through, at its far
// side.
TEST(GlassInGlass, WhatIsReflectedInsideIsAbsorbedToo) {
    Scene scene;
    scene.environment = half_white(0.0f, 1.0f);
    Material material = glass(1.5f, Reflectance::dielectric);
    material.absorption = glm::vec3(0.3f);
    place(scene, Sphere{{0, 0, 0}, 1.0}, add_material(scene, material));
    const double r = reflected(1.0, 1.5);
    const double inside = (1.0 - r) * (1.0 - r) * r * std::exp(-0.3 * 4.0);
    EXPECT_NEAR(from_above(scene, 4), r + inside, 1e-5);
}

}  // namespace
}  // namespace raypick
