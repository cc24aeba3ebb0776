// Lights against what pencil and paper say: a floor y = 0 looked at from above.
#include "tests/trace_shots.h"
#include "tracer/shade/random.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <functional>
#include <numbers>

namespace raypick {
namespace {

constexpr double kPi = std::numbers::pi;

Scene floor_under(const Light& light, const Material& material = white_material()) {
    Scene scene = dark_scene();
    place(scene, Plane{{0, 1, 0}, 0.0}, add_material(scene, material));
    scene.lights = {light};
    return scene;
}

// Looks at a point of the floor from right above it, from below the lights.
Ray down_at(double x, double z = 0.0) {
    return ray_towards(glm::vec3(glm::dvec3(x, 0.25, z)), {x, 0, z});
}

double brightness(const Scene& scene, const Ray& ray, std::uint64_t seed = 0, bool shadows = true) {
    RenderSettings settings;
    settings.shadows = shadows;
    return static_cast<double>(shoot(scene, ray, settings, seed).traced.colour.x);
}

// --- lights of no size --------------------------------------------------------------------------

// d^2 = x^2 + 4, N.L = 2 / d; 1 / (a + b d + c d^2).
TEST(LightForms, PointLightFallsOffAsItsAttenuationSays) {
    for (const Attenuation& a : {Attenuation{1, 0, 0}, Attenuation{0, 1, 0}, Attenuation{0, 0, 1},
                                 Attenuation{0.5, 0.25, 0.125}}) {
        const Scene scene = floor_under(PointLight{"lamp", {0, 2, 0}, glm::vec3(3.0f), a});
        for (const double x : {0.0, 0.3, 1.0, 4.0, 30.0}) {
            const double d = std::sqrt(x * x + 4.0);
            const double wanted =
                3.0 * (2.0 / d) / (a.constant + a.linear * d + a.quadratic * d * d);
            EXPECT_NEAR(brightness(scene, down_at(x)), wanted, 2e-6 * wanted) << x;
        }
    }
}

// Light at angle i from the normal, the eye at angle e on the other side. Phong: R.V = cos(i - e).
// Blinn: N.H = cos((i - e) / 2).
TEST(LightForms, HighlightsByAngle) {
    for (const LocalModel model : {LocalModel::phong, LocalModel::blinn_phong}) {
        Material glossy = black_material();
        glossy.diffuse = glm::vec3(0.3f);
        glossy.specular = glm::vec3(0.8f);
        glossy.shininess = 20.0f;
        glossy.model = model;
        for (const double i : {0.0, 0.4, 0.9, 1.3}) {
            const Scene scene = floor_under(
                DirectionalLight{"sun", {std::sin(i), -std::cos(i), 0}, glm::vec3(1.0f)}, glossy);
            for (const double e : {0.0, 0.3, 0.8, 1.2}) {
                const Ray ray = ray_towards(
                    glm::vec3(glm::dvec3(5.0 * std::sin(e), 5.0 * std::cos(e), 0)), {0, 0, 0});
                const double lobe =
                    model == LocalModel::phong ? std::cos(i - e) : std::cos(0.5 * (i - e));
                const double wanted = 0.3 * std::cos(i) + 0.8 * std::pow(lobe, 20.0);
                EXPECT_NEAR(brightness(scene, ray), wanted, 2e-5) << i << ' ' << e;
            }
        }
    }
}

// The notes' and glTF's cone: clamp((cos angle - cos outer) / (cos inner - cos outer), 0, 1)^2.
TEST(LightForms, SpotFadesFromItsInnerToItsOuterCone) {
    const double height = 3.0;
    SpotLight spot{"spot", {0, height, 0}, {0, -2, 0}, glm::vec3(1.0f), {}, 25.0, 40.0};
    const Scene scene = floor_under(spot);
    const double inner = std::cos(glm::radians(25.0));
    const double outer = std::cos(glm::radians(40.0));
    for (double degrees = 0.0; degrees < 60.0; degrees += 1.7) {
        const double cosine = std::cos(glm::radians(degrees));
        const double step = glm::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
        const double x = height * std::tan(glm::radians(degrees));
        EXPECT_NEAR(brightness(scene, down_at(0.6 * x, 0.8 * x)), cosine * step * step, 1e-5)
            << degrees;
    }
    // Equal angles: a sharp edge.
    spot.inner_degrees = spot.outer_degrees;
    const Scene sharp = floor_under(spot);
    const double edge = height * std::tan(glm::radians(40.0));
    EXPECT_NEAR(brightness(sharp, down_at(0.9999 * edge)), outer, 1e-3);
    EXPECT_EQ(brightness(sharp, down_at(1.0001 * edge)), 0.0);
}

// --- lights with an area ------------------------------------------------------------------------

// A disk of radius R straight above at height D, spread evenly: the mean over it of
//   N.L = D / sqrt(D^2 + r^2)             is 2 D (sqrt(D^2 + R^2) - D) / R^2,
//   N.L / d^2 = D / (D^2 + r^2)^(3/2)     is 2 D (1 / D - 1 / sqrt(D^2 + R^2)) / R^2.
TEST(LightForms, SphereLightStraightAbove) {
    for (const double radius : {0.1, 1.0, 3.0}) {
        for (const double height : {1.0, 4.0}) {
            const double far = std::hypot(height, radius);
            const double squared = radius * radius;
            SphereLight light{"bulb", {0, height, 0}, radius, glm::vec3(1.0f), {}, 64};
            EXPECT_NEAR(brightness(floor_under(light), down_at(0), 0, false),
                        2.0 * height * (far - height) / squared, 2e-4);
            light.attenuation = {0, 0, 1};
            EXPECT_NEAR(brightness(floor_under(light), down_at(0), 0, false),
                        2.0 * height * (1.0 / height - 1.0 / far) / squared, 2e-4);
        }
    }
}

// The solid angle of a rectangle a x b at height h over its corner.
double solid_angle(double a, double b, double h) {
    return std::atan(a * b / (h * std::sqrt(a * a + b * b + h * h)));
}

// A rectangle parallel to the floor with 1 / d^2: the integral of N.L / d^2 is its solid angle,
// since both see each other at the same angle.
TEST(LightForms, RectangleLightOverAFloorIsItsSolidAngle) {
    const double h = 1.5;
    const RectangleLight light{"panel",         {-1, h, -0.5}, {3, 0, 0}, {0, 0, 2},
                               glm::vec3(1.0f), {0, 0, 1},     64};
    const Scene scene = floor_under(light);
    for (const glm::dvec2& at : {glm::dvec2(0, 0), glm::dvec2(-1, -0.5), glm::dvec2(1.2, 0.9)}) {
        // Four rectangles with a corner right above; all lie within the panel.
        double angle = 0.0;
        for (const double a : {at.x + 1.0, 2.0 - at.x}) {
            for (const double b : {at.y + 0.5, 1.5 - at.y})
                angle += solid_angle(a, b, h);
        }
        EXPECT_NEAR(brightness(scene, down_at(at.x, at.y), 0, false), angle / 6.0, 2e-4);
    }
}

// The mean of N.L f(d) over a light's points, worked out as a sum over a fine grid.
double mean_over_grid(const std::function<glm::dvec3(double, double)>& point, const glm::dvec3& lit,
                      const Attenuation& a) {
    constexpr int kSteps = 400;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const glm::dvec3 to = point((i + 0.5) / kSteps, (j + 0.5) / kSteps) - lit;
            const double d = glm::length(to);
            sum += std::max(to.y, 0.0) / d / (a.constant + d * (a.linear + d * a.quadratic));
        }
    }
    return sum / (kSteps * kSteps);
}

TEST(LightForms, AreaLightsAnyhowPlacedAreTheMeanOfTheirPoints) {
    const Attenuation a{0.2, 0.1, 0.7};
    // Upright and slanted, half of it below the floor's horizon.
    const RectangleLight panel{
        "panel", {1, -0.8, -1}, {0.3, 2, 0.2}, {0.5, -0.1, 2}, glm::vec3(1.0f), a, 64};
    EXPECT_NEAR(
        brightness(floor_under(panel), down_at(0.2, 0.1), 0, false),
        mean_over_grid(
            [&](double u, double v) { return panel.corner + u * panel.edge_u + v * panel.edge_v; },
            {0.2, 0, 0.1}, a),
        3e-4);
    // The disk that faces the point, by polar coordinates of equal area.
    const SphereLight bulb{"bulb", {2, 1.5, -1}, 0.9, glm::vec3(1.0f), a, 64};
    const glm::dvec3 lit(0.2, 0, 0.1);
    const glm::dvec3 towards = glm::normalize(bulb.centre - lit);
    const glm::dvec3 across = glm::normalize(glm::cross(towards, {0, 0, 1}));
    const glm::dvec3 other = glm::cross(towards, across);
    const auto disk = [&](double u, double v) {
        const double r = bulb.radius * std::sqrt(u);
        return bulb.centre +
               r * (std::cos(2.0 * kPi * v) * across + std::sin(2.0 * kPi * v) * other);
    };
    EXPECT_NEAR(brightness(floor_under(bulb), down_at(0.2, 0.1), 0, false),
                mean_over_grid(disk, lit, a), 3e-4);
}

// Few samples are noisy, but right in the mean; a single one is the centre, without noise.
TEST(LightForms, FewSamplesAreRightInTheMean) {
    RectangleLight light{"panel", {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, glm::vec3(1.0f), {0, 0, 1}, 2};
    const Scene scene = floor_under(light);
    constexpr int kSeeds = 4000;
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const double value = brightness(scene, down_at(0), RandomSequence::derive(1, seed), false);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kSeeds;
    const double deviation = std::sqrt(squares / kSeeds - mean * mean);
    EXPECT_GT(deviation, 0.01);
    // Four standard errors.
    EXPECT_NEAR(mean, 4.0 * solid_angle(1, 1, 1) / 4.0, 4.0 * deviation / std::sqrt(kSeeds));
    light.samples = 1;
    EXPECT_NEAR(brightness(floor_under(light), down_at(0), 5), 1.0, 1e-6);
}

// --- soft shadows -------------------------------------------------------------------------------

constexpr double kEdge = 4.0;    // height of the screen
constexpr double kLight = 40.0;  // of the light
constexpr double kHalf = 2.0;    // half of the light's width

// A screen with x < 0 under the light: the floor at x sees the light's points beyond
// l = -x (light - edge) / edge.
Scene half_covered(const Light& light) {
    Scene scene = floor_under(light);
    place(scene, Rectangle{{-50, kEdge, -50}, {50, 0, 0}, {0, 0, 100}},
          add_material(scene, black_material()));
    return scene;
}

// The share of the light that a straight edge leaves free. Umbra and full light begin where
// |l| is half the light's width: the penumbra is 2 half * edge / (light - edge) wide.
void expect_penumbra(const Scene& scene, const std::function<double(double)>& free_share) {
    const double half_width = kHalf * kEdge / (kLight - kEdge);
    for (int i = -12; i <= 12; ++i) {
        const double x = i / 10.0 * half_width;
        const double l = glm::clamp(-x / half_width, -1.0, 1.0);
        const double seen =
            brightness(scene, down_at(x), 3) / brightness(scene, down_at(x), 3, false);
        if (i < -10) {
            EXPECT_EQ(seen, 0.0) << "umbra " << x;
        } else if (i > 10) {
            EXPECT_EQ(seen, 1.0) << "lit " << x;
        } else {
            EXPECT_NEAR(seen, free_share(l), 0.012) << x;
        }
    }
}

TEST(LightForms, PenumbraOfARectangleIsLinear) {
    expect_penumbra(half_covered(RectangleLight{"panel",
                                                {-kHalf, kLight, -kHalf},
                                                {2 * kHalf, 0, 0},
                                                {0, 0, 2 * kHalf},
                                                glm::vec3(1.0f),
                                                {},
                                                32}),
                    [](double l) { return 0.5 * (1.0 - l); });
}

// The segment of a disk beyond l: (acos l - l sqrt(1 - l^2)) / pi.
TEST(LightForms, PenumbraOfASphereIsTheSegmentOfADisk) {
    expect_penumbra(
        half_covered(SphereLight{"bulb", {0, kLight, 0}, kHalf, glm::vec3(1.0f), {}, 32}),
        [](double l) { return (std::acos(l) - l * std::sqrt(1.0 - l * l)) / kPi; });
}

// --- light without lights -----------------------------------------------------------------------

TEST(LightForms, AGlowingSurfaceIsSeenAndLightsNothing) {
    Scene scene = floor_under(PointLight{"lamp", {0, 9, 0}, glm::vec3(0.0f)});
    place(scene, Sphere{{0, 1, 0}, 0.5}, add_material(scene, glowing_material({2.0f, 0.5f, 0.0f})));
    expect_colour(shoot(scene, ray_towards({0, 3, 0}, {0, 0, 0})).traced.colour, {2.0, 0.5, 0.0});
    EXPECT_EQ(brightness(scene, down_at(1.0)), 0.0);
}

// Whatever way a wall splits its light between its own colour and what it mirrors or lets through:
// within walls that give back all of an ambient light of 1, everything is 1, but for what lies
// beyond the depth limit.
TEST(LightForms, FurnaceOfAmbientOne) {
    for (const double own : {1.0, 0.5, 0.25}) {
        Scene scene = dark_scene();
        scene.ambient = glm::vec3(1.0f);
        Material wall = black_material();
        wall.ambient = glm::vec3(static_cast<float>(own));
        wall.reflect = glm::vec3(static_cast<float>(1.0 - own));
        place(scene, Box{{-1, -2, -1.5}, {2, 1, 1}}, add_material(scene, wall));
        RenderSettings settings;
        settings.depth = 9;
        settings.cutoff = 0.0f;
        const Accel accel = accel_of(scene);
        Random random(5);
        for (int i = 0; i < 500; ++i) {
            Ray ray;
            ray.direction = glm::vec3(random.direction());
            RayCounts counts;
            const glm::vec3 colour = trace(accel, {}, settings, ray, counts).colour;
            // own (1 + r + ... + r^8) with r = 1 - own.
            expect_colour(colour, glm::dvec3(1.0 - std::pow(1.0 - own, 9)), 2e-6);
        }
    }
}

TEST(LightForms, FurnaceWithGlassInIt) {
    Scene scene = dark_scene();
    scene.ambient = glm::vec3(1.0f);
    Material wall = black_material();
    wall.ambient = glm::vec3(1.0f);
    place(scene, Box{glm::dvec3(-5), glm::dvec3(5)}, add_material(scene, wall));
    Material glass = glass_material();
    glass.reflect = glm::vec3(1.0f);
    glass.reflectance = Reflectance::dielectric;
    place(scene, Sphere{{0, 0, -2}, 1.0}, add_material(scene, glass));
    Material veil = wall;
    veil.opacity = 0.3f;
    veil.alpha_mode = AlphaMode::blend;
    place(scene, Sphere{{2, 0, 0}, 1.0}, add_material(scene, veil));
    RenderSettings settings;
    settings.depth = 14;
    settings.cutoff = 0.0f;
    const Accel accel = accel_of(scene);
    Random random(6);
    for (int i = 0; i < 60; ++i) {
        Ray ray;
        ray.direction = glm::vec3(random.direction());
        RayCounts counts;
        // What still goes back and forth in the ball at the depth limit is little.
        expect_colour(trace(accel, {}, settings, ray, counts).colour, glm::dvec3(1.0), 1e-4);
    }
}

}  // namespace
}  // namespace raypick
