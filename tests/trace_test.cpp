#include "tracer/shade/trace.h"

#include "tests/trace_shots.h"
#include "tracer/shade/local_light.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>

#include <cmath>

namespace raypick {
namespace {

// Without the counts by depth.
RayCounts sums(RayCounts counts) {
    counts.reflection_at = counts.refraction_at = counts.shadow_at = {};
    return counts;
}

Material phong_material() {
    Material material;
    material.ambient = {0.1f, 0.2f, 0.3f};
    material.diffuse = {0.5f, 0.25f, 0.125f};
    material.specular = {0.4f, 0.8f, 0.2f};
    material.shininess = 10.0f;
    return material;
}

// --- the local term -----------------------------------------------------------------------------

// N = +y, L = (0.6, 0.8, 0): N.L = 0.8, R = (-0.6, 0.8, 0).
TEST(Phong, ByHand) {
    const SurfaceMaterial m = plain(phong_material());
    const glm::vec3 n(0, 1, 0);
    const glm::vec3 l(0.6f, 0.8f, 0);
    // The eye in the mirror direction: R.V = 1.
    expect_colour(phong(m, n, l, {-0.6f, 0.8f, 0}),
                  0.8 * glm::dvec3(0.5, 0.25, 0.125) + glm::dvec3(0.4, 0.8, 0.2));
    // Straight above: R.V = 0.8, to the tenth.
    expect_colour(phong(m, n, l, {0, 1, 0}),
                  0.8 * glm::dvec3(0.5, 0.25, 0.125) + 0.1073741824 * glm::dvec3(0.4, 0.8, 0.2));
    // R.V < 0: no highlight.
    expect_colour(phong(m, n, l, {1, 0, 0}), 0.8 * glm::dvec3(0.5, 0.25, 0.125));
    // The light behind the surface.
    expect_colour(phong(m, n, {0.6f, -0.8f, 0}, {0.6f, 0.8f, 0}), {0, 0, 0});
}

// --- lit and shadowed points --------------------------------------------------------------------

Scene lit_floor() {
    Scene scene = dark_scene();
    scene.ambient = {0.5f, 0.5f, 1.0f};
    place(scene, Plane{{0, 1, 0}, 0.0}, add_material(scene, phong_material()));
    return scene;
}

// Ambient part of lit_floor.
const glm::dvec3 kAmbient(0.05, 0.1, 0.3);

TEST(Trace, PointLightOnAPlane) {
    Scene scene = lit_floor();
    scene.lights = {PointLight{"lamp", {3, 4, 0}, {1.0f, 2.0f, 0.5f}}};
    const Shot mirrored = shoot(scene, ray_towards({-3, 4, 0}, {0, 0, 0}));
    expect_colour(mirrored.traced.colour,
                  kAmbient + glm::dvec3(1.0, 2.0, 0.5) *
                                 (0.8 * glm::dvec3(0.5, 0.25, 0.125) + glm::dvec3(0.4, 0.8, 0.2)));
    const Shot above = shoot(scene, ray_towards({0, 5, 0}, {0, 0, 0}));
    expect_colour(above.traced.colour, kAmbient + glm::dvec3(1.0, 2.0, 0.5) *
                                                      (0.8 * glm::dvec3(0.5, 0.25, 0.125) +
                                                       0.1073741824 * glm::dvec3(0.4, 0.8, 0.2)));
    EXPECT_EQ(sums(above.counts), (RayCounts{.eye = 1, .eye_hits = 1, .shadow = 1}));
}

TEST(Trace, DirectionalLightOnAPlane) {
    Scene scene = lit_floor();
    scene.lights = {DirectionalLight{"sun", {-3, -4, 0}, {1.0f, 1.0f, 1.0f}}};
    const Shot above = shoot(scene, ray_towards({7, 5, 1}, {7, 0, 1}));
    expect_colour(above.traced.colour, kAmbient + 0.8 * glm::dvec3(0.5, 0.25, 0.125) +
                                           0.1073741824 * glm::dvec3(0.4, 0.8, 0.2));
}

TEST(Trace, LightsAddUp) {
    Scene scene = lit_floor();
    scene.lights = {DirectionalLight{"sun", {-3, -4, 0}, {1.0f, 1.0f, 1.0f}},
                    DirectionalLight{"moon", {0, -2, 0}, {0.5f, 0.5f, 0.5f}}};
    const Shot above = shoot(scene, ray_towards({7, 5, 1}, {7, 0, 1}));
    expect_colour(above.traced.colour, kAmbient + 1.3 * glm::dvec3(0.5, 0.25, 0.125) +
                                           (0.1073741824 + 0.5) * glm::dvec3(0.4, 0.8, 0.2));
    EXPECT_EQ(above.counts.shadow, 2u);
}

TEST(Trace, LightDoesNotFallOffWithDistance) {
    for (const double d : {1e-2, 1.0, 1e5}) {
        Scene scene = lit_floor();
        scene.lights = {PointLight{"lamp", {3 * d, 4 * d, 0}, glm::vec3(1.0f)}};
        const Shot shot = shoot(scene, ray_towards({0, 5, 0}, {0, 0, 0}));
        expect_colour(shot.traced.colour, kAmbient + 0.8 * glm::dvec3(0.5, 0.25, 0.125) +
                                              0.1073741824 * glm::dvec3(0.4, 0.8, 0.2));
    }
}

TEST(Trace, ShadowedPointsKeepTheirAmbient) {
    Scene scene = lit_floor();
    scene.lights = {PointLight{"lamp", {3, 4, 0}, glm::vec3(1.0f)}};
    place(scene, Sphere{{1.5, 2, 0}, 0.25});
    const Ray ray = ray_towards({-3, 4, 0}, {0, 0, 0});
    const Shot shadowed = shoot(scene, ray);
    expect_colour(shadowed.traced.colour, kAmbient);
    EXPECT_EQ(sums(shadowed.counts),
              (RayCounts{.eye = 1, .eye_hits = 1, .shadow = 1, .shadow_blocked = 1}));
    RenderSettings without;
    without.shadows = false;
    const Shot lit = shoot(scene, ray, without);
    EXPECT_GT(lit.traced.colour.x, 0.5f);
    EXPECT_EQ(lit.counts.shadow, 0u);
}

TEST(Trace, WhatLiesBeyondTheLightCastsNoShadow) {
    Scene scene = lit_floor();
    scene.lights = {PointLight{"lamp", {3, 4, 0}, glm::vec3(1.0f)}};
    place(scene, Sphere{{6, 8, 0}, 0.5});
    const Shot shot = shoot(scene, ray_towards({-3, 4, 0}, {0, 0, 0}));
    EXPECT_GT(shot.traced.colour.x, 0.5f);
    EXPECT_EQ(shot.counts.shadow_blocked, 0u);
    // A sun has no beyond.
    scene.lights = {DirectionalLight{"sun", {-3, -4, 0}, glm::vec3(1.0f)}};
    EXPECT_EQ(shoot(scene, ray_towards({-3, 4, 0}, {0, 0, 0})).counts.shadow_blocked, 1u);
}

TEST(Trace, NoShadowRayToALightBehindTheSurface) {
    Scene scene = lit_floor();
    scene.lights = {PointLight{"lamp", {3, -4, 0}, glm::vec3(1.0f)}};
    const Shot shot = shoot(scene, ray_towards({-3, 4, 0}, {0, 0, 0}));
    expect_colour(shot.traced.colour, kAmbient);
    EXPECT_EQ(shot.counts.shadow, 0u);
    // From below, the lower side is the lit one.
    const Shot below = shoot(scene, ray_towards({-3, -4, 0}, {0, 0, 0}));
    EXPECT_GT(below.traced.colour.x, 0.5f);
    EXPECT_FALSE(below.traced.hit.front_face);
}

TEST(Trace, NoSurfaceShadowsItself) {
    for (const double s : {1e-4, 1e-2, 1.0, 1e3, 1e6}) {
        for (const double away : {0.0, 1e3}) {
            SCOPED_TRACE(s);
            SCOPED_TRACE(away);
            const glm::dvec3 at = away * s * glm::dvec3(0.6, 0.3, -0.7);
            Scene scene = dark_scene();
            Material white = black_material();
            white.diffuse = glm::vec3(1.0f);
            const MaterialId id = add_material(scene, white);
            place_mesh(scene, ball_data(4), id, translate(at) * scale({s, s, s}));
            place(scene, Sphere{at + glm::dvec3(4 * s, 0, 0), s}, id);
            scene.lights = {DirectionalLight{"sun", {-0.3, -1.0, -0.5}, glm::vec3(1.0f)}};
            const Accel accel = accel_of(scene);
            Random random(9);
            RayCounts counts;
            for (int i = 0; i < 3000; ++i) {
                const glm::dvec3 middle = at + (i % 2 == 0 ? 0.0 : 4.0) * glm::dvec3(s, 0, 0);
                // From the side of the sun, so that the ball's neighbour is not in the way.
                const glm::dvec3 from =
                    middle +
                    5.0 * s * glm::normalize(glm::dvec3(0.0, 1.0, 0.5) + 0.3 * random.direction());
                trace(accel, scene.lights, {},
                      ray_towards(glm::vec3(from), middle + 0.6 * s * random.direction()), counts);
            }
            EXPECT_GT(counts.shadow, 1500u);
            EXPECT_EQ(counts.shadow_blocked, 0u);
        }
    }
}

// --- what needs no light ------------------------------------------------------------------------

TEST(Trace, BackgroundOnAMiss) {
    Scene scene;
    scene.background = {0.25f, 0.5f, 0.75f};
    const Shot shot = shoot(scene, Ray{});
    EXPECT_EQ(shot.traced.colour, scene.background);
    EXPECT_FALSE(shot.traced.hit.valid());
    EXPECT_EQ(shot.traced.normal, glm::vec3(0.0f));
    EXPECT_EQ(sums(shot.counts), (RayCounts{.eye = 1}));
}

TEST(Trace, EmissiveAndAmbient) {
    Scene scene = dark_scene();
    Material material = glowing_material({0.5f, 1.5f, 0.0f});
    material.ambient = {0.25f, 0.5f, 1.0f};
    scene.ambient = {0.5f, 0.5f, 0.25f};
    place(scene, Sphere{}, add_material(scene, material));
    const Shot shot = shoot(scene, ray_towards({0, 0, 5}, {0, 0, 0}));
    expect_colour(shot.traced.colour, {0.625, 1.75, 0.25});
}

TEST(Trace, TellsWhatWasHit) {
    Scene scene = dark_scene();
    place_mesh(scene, ball_data(2));
    const Accel accel = accel_of(scene);
    for (const glm::vec3& from : {glm::vec3(0, 0, 5), glm::vec3(0, 0, 0)}) {
        const Ray ray = ray_towards(from, {0.3, 0.2, from.z > 0 ? 0.0 : -5.0});
        RayCounts counts;
        const TracedRay traced = trace(accel, scene.lights, {}, ray, counts);
        ASSERT_TRUE(accel.intersect(ray).has_value());
        EXPECT_EQ(traced.hit, *accel.intersect(ray));
        EXPECT_NEAR(glm::length(traced.normal), 1.0f, 1e-5f);
        EXPECT_LT(glm::dot(traced.normal, ray.direction), 0.0f) << "towards the eye";
    }
}

// --- mirrors ------------------------------------------------------------------------------------

TEST(Trace, APerfectMirrorShowsWhatItReflects) {
    Scene scene = dark_scene();
    place(scene, Plane{{0, 1, 0}, 0.0}, add_material(scene, mirror_material()));
    // In at 45 degrees, out at 45 degrees: a pea 1000 radii away is met.
    place(scene, Sphere{{2, 2, 0}, 2e-3},
          add_material(scene, glowing_material({0.25f, 0.5f, 2.0f})));
    scene.background = {0.125f, 0.0f, 0.0f};
    const Shot pea = shoot(scene, ray_towards({-3, 3, 0}, {0, 0, 0}));
    expect_colour(pea.traced.colour, {0.25, 0.5, 2.0});
    EXPECT_EQ(pea.traced.hit.object, 0u) << "the mirror itself is what a pick finds";
    EXPECT_EQ(sums(pea.counts), (RayCounts{.eye = 1, .eye_hits = 1, .reflection = 1}));
    const Shot sky = shoot(scene, ray_towards({-3, 3, 0}, {0.5, 0, 0}));
    expect_colour(sky.traced.colour, {0.125, 0.0, 0.0});
}

TEST(Trace, MirrorsTintAndAddToTheirOwnColour) {
    Scene scene = dark_scene();
    Material tinted = glowing_material({0.5f, 0.0f, 0.0f});
    tinted.reflect = {0.5f, 0.25f, 1.0f};
    place(scene, Plane{{0, 1, 0}, 0.0}, add_material(scene, tinted));
    scene.background = {1.0f, 1.0f, 0.5f};
    expect_colour(shoot(scene, ray_towards({-3, 3, 0}, {0, 0, 0})).traced.colour, {1.0, 0.25, 0.5});
    RenderSettings without;
    without.reflections = false;
    const Shot plain = shoot(scene, ray_towards({-3, 3, 0}, {0, 0, 0}), without);
    expect_colour(plain.traced.colour, {0.5, 0.0, 0.0});
    EXPECT_EQ(plain.counts.reflection, 0u);
}

TEST(Trace, MirrorCorridorHasAsManyBouncesAsItsDepth) {
    Scene scene = dark_scene();
    scene.background = glm::vec3(9.0f);
    Material wall = glowing_material({0.25f, 1.0f, 0.0f});
    wall.reflect = glm::vec3(0.5f);
    const MaterialId id = add_material(scene, wall);
    place(scene, Plane{{0, 0, 1}, 1.0}, id);
    place(scene, Plane{{0, 0, -1}, 1.0}, id);
    for (int depth = 1; depth <= 12; ++depth) {
        SCOPED_TRACE(depth);
        RenderSettings settings;
        settings.depth = depth;
        settings.cutoff = 0.0f;
        const Shot shot = shoot(scene, Ray{}, settings);
        // 1 + 1/2 + 1/4 + ...
        const double sum = 2.0 - std::pow(0.5, depth - 1);
        expect_colour(shot.traced.colour, {0.25 * sum, sum, 0.0});
        EXPECT_EQ(shot.counts.reflection, static_cast<std::uint64_t>(depth - 1));
        EXPECT_EQ(shot.counts.eye, 1u);
        EXPECT_EQ(shot.counts.total(), static_cast<std::uint64_t>(depth));
    }
}

// --- glass --------------------------------------------------------------------------------------

// A slab z in [0, 1], a white wall at z = -2 and a lamp 1 before the wall: the wall's brightness
// says where the ray met it, since N.L = 1 / sqrt(1 + dx^2).
double offset_from_lamp(float ior, double lamp_x, RayCounts& counts) {
    Scene scene = dark_scene();
    place(scene, Box{{-100, -100, 0}, {100, 100, 1}}, add_material(scene, glass_material(ior)));
    Material white = black_material();
    white.diffuse = glm::vec3(1.0f);
    place(scene, Plane{{0, 0, 1}, 2.0}, add_material(scene, white));
    scene.lights = {PointLight{"lamp", {lamp_x, 0, -1}, glm::vec3(1.0f)}};
    const Shot shot = shoot(scene, ray_towards({0, 0, 5}, {5, 0, 0}));
    counts = shot.counts;
    const auto cosine = static_cast<double>(shot.traced.colour.x);
    return std::sqrt(1.0 / (cosine * cosine) - 1.0);
}

TEST(Trace, ASlabDisplacesInParallel) {
    for (const double ior : {1.0, 1.1, 1.33, 1.5, 2.4}) {
        SCOPED_TRACE(ior);
        // In at 45 degrees at x = 4; Snell inside; out at 45 degrees over 2 units.
        const double inside = std::asin(std::sin(std::atan(1.0)) / ior);
        const double wall = 4.0 + std::tan(inside) + 2.0;
        RayCounts counts;
        EXPECT_NEAR(offset_from_lamp(static_cast<float>(ior), wall + 1.0, counts), 1.0, 1e-5);
        EXPECT_NEAR(offset_from_lamp(static_cast<float>(ior), wall - 2.0, counts), 2.0, 1e-5);
        EXPECT_EQ(counts.refraction, 2u);
        EXPECT_EQ(counts.reflection, 0u);
    }
}

// A ray inside the glass ball, upwards at distance `x` from the centre, and a pea of light
// at `pea`.
Shot inside_ball(float x, const glm::dvec3& pea, const RenderSettings& settings = {}) {
    Scene scene = dark_scene();
    place(scene, Sphere{}, add_material(scene, glass_material()));
    place(scene, Sphere{pea, 1e-4}, add_material(scene, glowing_material(glm::vec3(1.0f))));
    return shoot(scene, ray_towards({x, 0, 0}, {static_cast<double>(x), 9, 0}), settings);
}

TEST(Trace, GlassBallRefractsOutwardsByHand) {
    // Normal at 60 degrees, incidence 30: sin 48.59 = 1.5 sin 30. Out at 60 + 48.59 degrees.
    const double out = std::acos(0.5) + std::asin(0.75);
    const glm::dvec3 exit(0.5, std::sqrt(0.75), 0.0);
    const Shot shot = inside_ball(0.5f, exit + glm::dvec3(std::cos(out), std::sin(out), 0.0));
    expect_colour(shot.traced.colour, {1, 1, 1});
    EXPECT_EQ(shot.counts.refraction, 1u);
    EXPECT_EQ(shot.counts.reflection, 0u);
}

TEST(Trace, GlassBallReflectsTotallyByHand) {
    // sin i = 0.9 > 1 / 1.5. d' = d - 2 (d.n) n with n = (0.9, sqrt(0.19)).
    const glm::dvec3 turn(0.9, std::sqrt(0.19), 0.0);
    const glm::dvec3 direction(-2 * 0.9 * turn.y, 1.0 - 2 * 0.19, 0.0);
    const Shot shot = inside_ball(0.9f, turn + 0.5 * direction);
    expect_colour(shot.traced.colour, {1, 1, 1});
    EXPECT_EQ(shot.counts.refraction, 0u);
    EXPECT_EQ(shot.counts.reflection, 1u);
}

TEST(Trace, TheCriticalAngleLiesAtOneOverIor) {
    const glm::dvec3 nowhere(0, 0, 50);
    EXPECT_EQ(inside_ball(0.6666f, nowhere).counts.refraction, 1u);
    EXPECT_EQ(inside_ball(0.6668f, nowhere).counts.refraction, 0u);
}

TEST(Trace, ATrappedRayEndsAtTheDepthLimit) {
    for (const int depth : {1, 2, 7, 50}) {
        RenderSettings settings;
        settings.depth = depth;
        const Shot shot = inside_ball(0.9f, {0, 0, 50}, settings);
        EXPECT_EQ(shot.counts.reflection, static_cast<std::uint64_t>(depth - 1));
        EXPECT_EQ(shot.counts.refraction, 0u);
        EXPECT_EQ(shot.traced.colour, glm::vec3(0.0f));
    }
}

// A right-angled prism, its hypotenuse x + y = 1, extruded along z.
MeshData prism_data() {
    MeshData data;
    data.positions = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    data.triangles = {{3, 4, 5}, {0, 2, 1}, {0, 1, 4}, {0, 4, 3},
                      {1, 2, 5}, {1, 5, 4}, {0, 3, 5}, {0, 5, 2}};
    return data;
}

TEST(Trace, APrismTurnsTheViewByARightAngle) {
    Scene scene = dark_scene();
    place_mesh(scene, prism_data(), add_material(scene, glass_material()));
    place(scene, Sphere{{0.7, -2, 0.1}, 1e-4},
          add_material(scene, glowing_material({0.5f, 1.0f, 2.0f})));
    Ray ray;
    ray.origin = {-2.0f, 0.3f, 0.1f};
    ray.direction = {1, 0, 0};
    const Shot shot = shoot(scene, ray);
    expect_colour(shot.traced.colour, {0.5, 1.0, 2.0});
    EXPECT_EQ(sums(shot.counts),
              (RayCounts{.eye = 1, .eye_hits = 1, .reflection = 1, .refraction = 2}));
    RenderSettings shallow;
    shallow.depth = 3;
    EXPECT_EQ(shoot(scene, ray, shallow).traced.colour, glm::vec3(0.0f));
}

TEST(Trace, WithoutRefractionGlassIsOpaque) {
    Scene scene = dark_scene();
    scene.background = glm::vec3(1.0f);
    place(scene, Sphere{}, add_material(scene, glass_material()));
    RenderSettings without;
    without.refractions = false;
    const Shot shot = shoot(scene, ray_towards({0, 0, 5}, {0, 0, 0}), without);
    EXPECT_EQ(shot.traced.colour, glm::vec3(0.0f));
    EXPECT_EQ(shot.counts.refraction, 0u);
    expect_colour(shoot(scene, ray_towards({0, 0, 5}, {0, 0, 0})).traced.colour, {1, 1, 1});
}

TEST(Trace, DepthOneMeansNoSecondaryRays) {
    Scene scene = dark_scene();
    scene.background = glm::vec3(1.0f);
    Material both = glass_material();
    both.reflect = glm::vec3(1.0f);
    both.diffuse = glm::vec3(0.5f);
    place(scene, Sphere{}, add_material(scene, both));
    scene.lights = {DirectionalLight{"sun", {0, 0, -1}, glm::vec3(1.0f)}};
    RenderSettings settings;
    settings.depth = 1;
    const Shot shot = shoot(scene, ray_towards({0, 0, 5}, {0, 0, 0}), settings);
    expect_colour(shot.traced.colour, {0.5, 0.5, 0.5});
    EXPECT_EQ(sums(shot.counts), (RayCounts{.eye = 1, .eye_hits = 1, .shadow = 1}));
}

TEST(Trace, CountsEveryRayOfATree) {
    // Reflecting glass: at each hit one ray goes each way, until the depth is reached.
    Scene scene = dark_scene();
    Material both = glass_material(1.2f);
    both.reflect = glm::vec3(0.5f);
    place(scene, Box{{-9, -9, 0}, {9, 9, 1}}, add_material(scene, both));
    RenderSettings settings;
    settings.depth = 4;
    const Shot shot = shoot(scene, ray_towards({0, 0, 5}, {1, 0, 0}), settings);
    // Depth 1 hits outside: one ray leaves for the sky, one goes in. Depths 2 and 3 hit from
    // inside: one goes out to the sky, one stays in. Depth 4 hits and ends.
    EXPECT_EQ(shot.counts.reflection, 3u);
    EXPECT_EQ(shot.counts.refraction, 3u);
}

TEST(RayCounts, AddUp) {
    RayCounts counts{1, 2, 3, 4, 5, 6};
    counts += RayCounts{10, 20, 30, 40, 50, 60};
    EXPECT_EQ(counts, (RayCounts{11, 22, 33, 44, 55, 66}));
    EXPECT_EQ(counts.total(), 11u + 33u + 44u + 55u);
}

}  // namespace
}  // namespace raypick
