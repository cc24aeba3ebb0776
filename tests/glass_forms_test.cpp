// Glass against what pencil and paper say.
#include "tests/trace_shots.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace raypick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGlass = 1.5;
constexpr double kWater = 1.33;

// The angle beyond a surface, Snell: n sin(angle) = n' sin(angle').
double refracted(double angle, double n, double beyond) {
    return std::asin(n * std::sin(angle) / beyond);
}

// Fresnel's equations by angles, as textbooks have them; the tracer's are written by cosines.
double fresnel(double angle, double n, double beyond) {
    if (angle == 0.0) return std::pow((n - beyond) / (n + beyond), 2);
    const double other = refracted(angle, n, beyond);
    const double across = std::sin(angle - other) / std::sin(angle + other);
    const double along = std::tan(angle - other) / std::tan(angle + other);
    return 0.5 * (across * across + along * along);
}

Material dielectric(double ior) {
    Material material = glass_material(static_cast<float>(ior));
    material.reflect = glm::vec3(1.0f);
    material.reflectance = Reflectance::dielectric;
    return material;
}

// What enters it is gone.
Material black_glass(double ior) {
    Material material = dielectric(ior);
    material.absorption = glm::vec3(1e4f);
    return material;
}

RenderSettings to_depth(int depth) {
    RenderSettings settings;
    settings.depth = depth;
    settings.cutoff = 0.0f;
    return settings;
}

// Down onto z = 0 at (0, 0, 0), `angle` off the normal in the x-z plane.
Ray ray_at(double angle) {
    return ray_towards(glm::vec3(glm::dvec3(-8.0 * std::sin(angle), 0, 8.0 * std::cos(angle))),
                       {0, 0, 0});
}

// A horizontal layer from z = -bottom up to z = -top.
Box layer(double top, double bottom) {
    return {{-1e3, -1e3, -bottom}, {1e3, 1e3, -top}};
}

// --- where rays go ------------------------------------------------------------------------------

constexpr double kPea = 1e-5;

// Whether the ray meets a pea of light of this radius there.
bool meets(Scene scene, const Ray& ray, const glm::dvec3& pea, double radius = kPea) {
    place(scene, Sphere{pea, radius}, add_material(scene, glowing_material(glm::vec3(1.0f))));
    return shoot(scene, ray, to_depth(20)).traced.colour.x > 0.5f;
}

// A ray at distance b from the middle of a ball goes in at asin b, on at asin(b / n), and leaves
// turned by twice the difference.
TEST(GlassForms, ABallTurnsRaysBySnellsLaw) {
    for (const double ior : {1.1, 1.33, 1.5, 2.4}) {
        Scene scene = dark_scene();
        place(scene, Sphere{}, add_material(scene, glass_material(static_cast<float>(ior))));
        for (const double b : {0.0, 0.2, 0.5, 0.8, 0.95}) {
            SCOPED_TRACE(testing::Message() << ior << ' ' << b);
            const double in = std::asin(b);
            const double inside = std::asin(b / ior);
            // Travelling along -z at height b; the entry is at angle `in` from +z, the exit a chord
            // that spans pi - 2 inside farther round, and the ray turns towards the axis.
            const double exit_angle = in + (kPi - 2.0 * inside);
            const glm::dvec3 exit(std::sin(exit_angle), 0, std::cos(exit_angle));
            const double turned = 2.0 * (in - inside);
            const glm::dvec3 direction(-std::sin(turned), 0, -std::cos(turned));
            Ray ray;
            ray.origin = {static_cast<float>(b), 0, 3};
            EXPECT_TRUE(meets(scene, ray, exit + direction));
            const glm::dvec3 aside(std::cos(turned), 0, -std::sin(turned));
            EXPECT_FALSE(meets(scene, ray, exit + direction + 3.0 * kPea * aside));
        }
    }
}

// Layers one below the other: n sin(angle) is the same in all of them.
struct Stratum {
    double thickness;
    double ior;
};

// Where a ray that meets z = 0 at this angle is one unit below the layers.
glm::dvec3 below(const std::vector<Stratum>& strata, double angle) {
    glm::dvec3 p(0.0);
    for (const Stratum& stratum : strata) {
        p.x += stratum.thickness * std::tan(refracted(angle, 1.0, stratum.ior));
        p.z -= stratum.thickness;
    }
    return p + glm::dvec3(std::tan(angle), 0, -1);
}

void expect_strata(const Scene& scene, const std::vector<Stratum>& strata) {
    for (const double angle : {0.0, 0.3, 0.8, 1.2}) {
        SCOPED_TRACE(angle);
        const glm::dvec3 end = below(strata, angle);
        EXPECT_TRUE(meets(scene, ray_at(angle), end, 3 * kPea));
        EXPECT_FALSE(meets(scene, ray_at(angle), end + glm::dvec3(20 * kPea, 0, 0), 3 * kPea));
    }
}

TEST(GlassForms, ASlabShiftsByThicknessTimesSineOfTheDifference) {
    Scene scene = dark_scene();
    place(scene, layer(0, 2), add_material(scene, glass_material()));
    expect_strata(scene, {{2, kGlass}});
    // The shift across the ray: d sin(i - t) / cos t.
    const double i = 0.8;
    const double t = refracted(i, 1.0, kGlass);
    const glm::dvec3 straight(3.0 * std::tan(i), 0, -3);
    const glm::dvec3 across(std::cos(i), 0, std::sin(i));
    EXPECT_NEAR(glm::dot(straight - below({{2, kGlass}}, i), across),
                2.0 * std::sin(i - t) / std::cos(t), 1e-12);
}

// From inside at 1 / n the refracted ray runs along the surface; beyond it there is none.
TEST(GlassForms, TotalReflectionBeginsAtTheCriticalAngle) {
    for (const double ior : {1.1, 1.5, 2.4}) {
        Scene scene = dark_scene();
        place(scene, layer(-5, 0), add_material(scene, glass_material(static_cast<float>(ior))));
        const double critical = std::asin(1.0 / ior);
        const auto counts = [&](double angle) {
            Ray ray = ray_at(angle);
            ray.origin *= 0.25f;      // inside
            RenderSettings settings;  // with the cutoff: only what carries light
            settings.depth = 2;
            return shoot(scene, ray, settings).counts;
        };
        EXPECT_EQ(counts(critical - 1e-5).refraction, 1u);
        EXPECT_EQ(counts(critical - 1e-5).reflection, 0u);
        EXPECT_EQ(counts(critical + 1e-5).refraction, 0u);
        EXPECT_EQ(counts(critical + 1e-5).reflection, 1u);
    }
}

// --- how much of the light ----------------------------------------------------------------------

TEST(GlassForms, FresnelOfADielectric) {
    for (const double ior : {1.33, 1.5, 2.4}) {
        for (const double degrees : {0.0, 45.0, 80.0}) {
            SCOPED_TRACE(testing::Message() << ior << ' ' << degrees);
            const double angle = glm::radians(degrees);
            const double wanted = fresnel(angle, 1.0, ior);
            Scene scene = dark_scene();
            scene.background = glm::vec3(1.0f);
            place(scene, layer(0, 50), add_material(scene, black_glass(ior)));
            expect_colour(shoot(scene, ray_at(angle), to_depth(2)).traced.colour,
                          glm::dvec3(wanted), 2e-6);
            // What is not reflected goes through: a light inside, nothing above.
            Scene other = dark_scene();
            place(other, layer(0, 50), add_material(other, dielectric(ior)));
            place(other, Plane{{0, 0, 1}, 20.0},
                  add_material(other, glowing_material(glm::vec3(1.0f))));
            expect_colour(shoot(other, ray_at(angle), to_depth(2)).traced.colour,
                          glm::dvec3(1.0 - wanted), 2e-6);
        }
    }
    // The table value for glass.
    EXPECT_NEAR(fresnel(0.0, 1.0, 1.5), 0.04, 1e-15);
}

// From inside at the angle that the ray would have inside, the share is the same.
TEST(GlassForms, FresnelIsTheSameBothWays) {
    for (const double degrees : {0.0, 45.0, 80.0}) {
        const double outside = glm::radians(degrees);
        const double inside = refracted(outside, 1.0, kGlass);
        Scene scene = dark_scene();
        scene.background = glm::vec3(1.0f);
        place(scene, layer(-5, 0), add_material(scene, dielectric(kGlass)));
        Ray ray = ray_at(inside);
        ray.origin *= 0.25f;
        expect_colour(shoot(scene, ray, to_depth(2)).traced.colour,
                      glm::dvec3(1.0 - fresnel(outside, 1.0, kGlass)), 5e-6);
    }
}

// Schlick: F0 + (1 - F0) (1 - cos)^5, by channel.
TEST(GlassForms, FresnelOfAConductor) {
    Material gold = black_material();
    gold.reflect = {1.0f, 0.78f, 0.34f};
    gold.reflectance = Reflectance::conductor;
    Scene scene = dark_scene();
    scene.background = glm::vec3(1.0f);
    place(scene, layer(0, 1), add_material(scene, gold));
    for (const double degrees : {0.0, 45.0, 80.0}) {
        const double angle = glm::radians(degrees);
        const glm::dvec3 facing(gold.reflect);
        const glm::dvec3 wanted = facing + (1.0 - facing) * std::pow(1.0 - std::cos(angle), 5);
        expect_colour(shoot(scene, ray_at(angle)).traced.colour, wanted, 2e-6);
    }
}

// A sheet: F (1 + (1-F)^2 + (1-F)^2 F^2 + ...) = 2 F / (1 + F) back, the rest straight on.
TEST(GlassForms, ThinWallsReflectAtBothFaces) {
    Material pane = dielectric(kGlass);
    pane.thin_walled = true;
    for (const double degrees : {0.0, 45.0, 80.0}) {
        const double angle = glm::radians(degrees);
        const double f = fresnel(angle, 1.0, kGlass);
        double sum = f;  // the series itself
        for (int k = 0; k < 200; ++k)
            sum += (1.0 - f) * (1.0 - f) * std::pow(f, 2 * k + 1);
        EXPECT_NEAR(sum, 2.0 * f / (1.0 + f), 1e-12);
        Scene scene = dark_scene();
        place(scene, Rectangle{{-50, -50, 0}, {100, 0, 0}, {0, 100, 0}}, add_material(scene, pane));
        EXPECT_TRUE(angle > 1.3 || meets(scene, ray_at(angle), below({}, angle)));
        scene.background = {1.0f, 0.0f, 0.0f};
        place(scene, Plane{{0, 0, 1}, 1.0}, add_material(scene, glowing_material({0, 1, 0})));
        expect_colour(shoot(scene, ray_at(angle)).traced.colour, {sum, 1.0 - sum, 0.0}, 2e-6);
    }
}

// exp(-a d) of the light passes d units of the inside.
TEST(GlassForms, BeersLawByThicknessAndAngle) {
    Material tinted = glass_material();
    tinted.absorption = {0.1f, 0.5f, 2.0f};
    for (const double thickness : {0.01, 1.0, 3.0}) {
        Scene scene = dark_scene();
        scene.background = glm::vec3(1.0f);
        place(scene, layer(0, thickness), add_material(scene, tinted));
        for (const double angle : {0.0, 0.7, 1.3}) {
            const double d = thickness / std::cos(refracted(angle, 1.0, kGlass));
            expect_colour(shoot(scene, ray_at(angle)).traced.colour,
                          glm::exp(-d * glm::dvec3(tinted.absorption)), 2e-6);
        }
    }
}

// --- glass in glass -----------------------------------------------------------------------------

Scene glass_and_water(const Box& glass, int glass_priority, const Box& water, int water_priority) {
    Scene scene = dark_scene();
    Material solid = glass_material(static_cast<float>(kGlass));
    solid.priority = glass_priority;
    Material liquid = glass_material(static_cast<float>(kWater));
    liquid.priority = water_priority;
    place(scene, glass, add_material(scene, solid));
    place(scene, water, add_material(scene, liquid));
    return scene;
}

TEST(NestedGlass, GlassWithinWaterBendsByBothIndices) {
    for (const int priority : {0, 1}) {
        expect_strata(glass_and_water(layer(1, 3), priority, layer(0, 4), 0),
                      {{1, kWater}, {2, kGlass}, {1, kWater}});
    }
    // Of a higher priority, the water leaves no room for the glass.
    expect_strata(glass_and_water(layer(1, 3), 0, layer(0, 4), 1), {{4, kWater}});
}

TEST(NestedGlass, WhereTheyOverlapTheHigherPriorityIsThere) {
    const Box water = layer(0, 4);
    const Box glass = layer(2, 5);
    expect_strata(glass_and_water(glass, 1, water, 0), {{2, kWater}, {3, kGlass}});
    expect_strata(glass_and_water(glass, 0, water, 1), {{4, kWater}, {1, kGlass}});
    // The surface that is not there is neither counted nor takes of the depth.
    const Shot shot = shoot(glass_and_water(glass, 1, water, 0), ray_at(0.5));
    EXPECT_EQ(shot.counts.refraction, 3u);
}

// Of equal ones, the one entered last: what is there depends on the side that a ray comes from.
TEST(NestedGlass, OfEqualPrioritiesTheOneEnteredLastIsThere) {
    expect_strata(glass_and_water(layer(2, 5), 0, layer(0, 4), 0), {{2, kWater}, {3, kGlass}});
    expect_strata(glass_and_water(layer(0, 4), 0, layer(2, 5), 0), {{2, kGlass}, {3, kWater}});
}

// At right angles: F of water, and F at the boundary of both indices twice through the former.
TEST(NestedGlass, TheBoundaryReflectsByBothIndices) {
    Scene scene = dark_scene();
    scene.background = glm::vec3(1.0f);
    Material water = dielectric(kWater);
    Material glass = black_glass(kGlass);
    glass.priority = 1;
    place(scene, layer(0, 4), add_material(scene, water));
    place(scene, layer(2, 9), add_material(scene, glass));
    const double top = fresnel(0.0, 1.0, kWater);
    const double between = fresnel(0.0, kWater, kGlass);
    EXPECT_NEAR(between, std::pow(0.17 / 2.83, 2), 1e-15);
    expect_colour(shoot(scene, ray_at(0.0), to_depth(4)).traced.colour,
                  glm::dvec3(top + (1.0 - top) * (1.0 - top) * between), 2e-6);
}

// A bubble: a body of index 1 within glass.
TEST(NestedGlass, AirWithinGlassIsABubble) {
    for (const int priority : {0, 1}) {
        Scene scene = dark_scene();
        Material air = glass_material(1.0f);
        air.priority = priority;
        place(scene, layer(0, 4), add_material(scene, glass_material()));
        place(scene, layer(1, 3), add_material(scene, air));
        expect_strata(scene, {{1, kGlass}, {2, 1.0}, {1, kGlass}});
    }
}

// Sheets of index 1 that bound nothing stay there, one behind the other.
TEST(NestedGlass, OpenSheetsOfIndexOneAllTint) {
    Scene scene = dark_scene();
    scene.background = glm::vec3(1.0f);
    Material tint = glass_material(1.0f);
    tint.transmit = {0.5f, 0.9f, 0.25f};
    const MaterialId id = add_material(scene, tint);
    for (const double z : {0.0, -1.0, -2.0})
        place(scene, Rectangle{{-50, -50, z}, {100, 0, 0}, {0, 100, 0}}, id);
    const glm::dvec3 once(tint.transmit);
    expect_colour(shoot(scene, ray_at(0.4)).traced.colour, once * once * once);
    RenderSettings tinted;
    tinted.glass_shadows = GlassShadows::tinted;
    place(scene, Plane{{0, 0, 1}, 3.0}, add_material(scene, white_material()));
    scene.lights = {DirectionalLight{"sun", {0, 0, -1}, glm::vec3(1.0f)}};
    expect_colour(shoot(scene, ray_towards({0, 0, -2.5f}, {0.3, 0, -3}), tinted).traced.colour,
                  once * once * once);
}

// --- shadows and veils --------------------------------------------------------------------------

// A white floor at z = -3 under a slanted sun, seen from between it and what lies above.
glm::vec3 floor_behind(const Shape& shape, const Material& material, GlassShadows shadows,
                       double sun) {
    Scene scene = dark_scene();
    place(scene, shape, add_material(scene, material));
    place(scene, Plane{{0, 0, 1}, 3.0}, add_material(scene, white_material()));
    scene.lights = {DirectionalLight{"sun", {std::sin(sun), 0, -std::cos(sun)}, glm::vec3(1.0f)}};
    RenderSettings settings;
    settings.glass_shadows = shadows;
    return shoot(scene, ray_towards({0, 0, -2.5f}, {0, 0, -3}), settings).traced.colour;
}

// Unbent through a slab: transmit at each face, exp(-a d / cos) between them.
TEST(GlassShadows, TintedByTransmitAndAbsorption) {
    Material glass = glass_material();
    glass.transmit = {0.9f, 0.5f, 0.2f};
    glass.absorption = {0.0f, 0.3f, 1.0f};
    for (const double sun : {0.0, 0.6}) {
        const glm::dvec3 t(glass.transmit);
        const glm::dvec3 wanted =
            std::cos(sun) * t * t * glm::exp(-2.0 / std::cos(sun) * glm::dvec3(glass.absorption));
        expect_colour(floor_behind(layer(0, 2), glass, GlassShadows::tinted, sun), wanted, 2e-6);
        // The notes' rule.
        expect_colour(floor_behind(layer(0, 2), glass, GlassShadows::opaque, sun), {0, 0, 0});
    }
}

TEST(GlassShadows, VeilsLetThroughWhatTheyDoNotCover) {
    Material veil = white_material();
    veil.opacity = 0.25f;
    veil.alpha_mode = AlphaMode::blend;
    const Rectangle sheet{{-50, -50, 0}, {100, 0, 0}, {0, 100, 0}};
    expect_colour(floor_behind(sheet, veil, GlassShadows::tinted, 0.0), glm::dvec3(0.75));
    expect_colour(floor_behind(sheet, veil, GlassShadows::opaque, 0.0), {0, 0, 0});
    veil.transmit = {1.0f, 0.5f, 0.0f};
    veil.thin_walled = true;
    expect_colour(floor_behind(sheet, veil, GlassShadows::tinted, 0.0), {1.0, 0.875, 0.75});
}

// opacity * own + (1 - opacity) * what is behind, sheet after sheet.
TEST(Veils, BlendWithWhatIsBehind) {
    Scene scene = dark_scene();
    scene.background = {0.0f, 0.0f, 1.0f};
    Material veil = glowing_material({1.0f, 0.5f, 0.0f});
    veil.opacity = 0.25f;
    veil.alpha_mode = AlphaMode::blend;
    const MaterialId id = add_material(scene, veil);
    for (int sheets = 1; sheets <= 4; ++sheets) {
        place(scene, Rectangle{{-50, -50, -1.0 * sheets}, {100, 0, 0}, {0, 100, 0}}, id);
        const double left = std::pow(0.75, sheets);
        const Shot shot = shoot(scene, ray_at(0.3));
        expect_colour(shot.traced.colour, {1.0 - left, 0.5 * (1.0 - left), left});
        EXPECT_EQ(shot.counts.refraction, static_cast<std::uint64_t>(sheets));
    }
}

// Two facing dielectric mirrors that light enters between: each bounce is one more factor R.
TEST(MirrorCorridor, LosesTheSameShareAtEveryBounce) {
    Scene scene = dark_scene();
    const MaterialId mirror = add_material(scene, mirror_material(0.9f));
    place(scene, Rectangle{{-1, -1, 0}, {19.5, 0, 0}, {0, 2, 0}}, mirror);
    place(scene, Rectangle{{-1, -1, 1}, {19.5, 0, 0}, {0, 2, 0}}, mirror);
    scene.background = glm::vec3(1.0f);
    // 45 degrees between walls 1 apart that end at x = 18.5: one bounce a unit.
    for (int start = 0; start < 19; ++start) {
        const int bounces = 19 - start;
        Ray ray;
        ray.origin = {static_cast<float>(start) - 0.25f, 0, 0.25f};
        ray.direction = glm::normalize(glm::vec3(1, 0, -1));
        const Shot shot = shoot(scene, ray, to_depth(30));
        EXPECT_EQ(shot.counts.reflection, static_cast<std::uint64_t>(bounces));
        expect_colour(shot.traced.colour, glm::dvec3(std::pow(0.9, bounces)), 2e-6);
        // One ray too few: the last wall is black.
        expect_colour(shoot(scene, ray, to_depth(bounces)).traced.colour, {0, 0, 0});
        expect_colour(shoot(scene, ray, to_depth(bounces + 1)).traced.colour,
                      glm::dvec3(std::pow(0.9, bounces)), 2e-6);
    }
}

}  // namespace
}  // namespace raypick
