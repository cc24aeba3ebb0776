// Ray counts of the Standard Procedural Databases against two published tables:
//   Eric Haines, SPD Readme.txt, "Database Analysis";
//   Havran, Sixta, statistics on grids (SPD docs/havran_stats_grids.txt), 1999.
// Rules behind them: 513 x 513 eye rays through the corners of a 512 x 512 image, depth 5, no
// cut-off by contribution, every hit on a reflective or transmitting surface reflects.
#include "tests/needs.h"
#include "tracer/io/load.h"
#include "tracer/render/render_job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

namespace raypick {
namespace {

struct Published {
    const char* scene;
    bool glass;
    // Of each kind the number of Haines and that of Havran.
    std::array<double, 2> eye_hits, secondary, shadow;
    double shadow_blocked;  // Havran's only
};

constexpr std::array<Published, 4> kPublished{{
    {"balls", false, {263169, 263169}, {175095, 179884}, {954368, 959244}, 285178},
    {"mount", true, {173125, 173685}, {709538, 710436}, {412922, 361037}, 74555},
    {"rings", false, {263169, 263169}, {315236, 312879}, {1085002, 1077336}, 510719},
    {"tetra", false, {49788, 49950}, {0, 0}, {46112, 46262}, 5538},
}};

RayCounts traced(const std::string& name) {
    LoadedScene loaded = load_scene(model("spd/" + name + ".nff"));
    const auto accel =
        std::make_shared<const Accel>(std::make_shared<const Scene>(std::move(loaded.scene)));
    constexpr ImageSize kSize{512, 512};
    RenderSettings settings;
    settings.sampling = Sampling::corners;
    settings.depth = 5;
    settings.cutoff = 0.0f;
    const RenderedFrame frame =
        render(accel, choose_camera(accel->scene(), kSize, {}), kSize, settings);
    EXPECT_EQ(frame.nan_pixels, 0u);
    return frame.rays;
}

// How far a count is from the nearer of two published ones, as a fraction.
double deviation(double count, const std::array<double, 2>& published) {
    double least = 1e9;
    for (const double value : published) {
        if (count == value) return 0.0;
        least = std::min(least, std::abs(count - value) / value);
    }
    return least;
}

class SpdOracleTest : public testing::TestWithParam<Published> {};

// The gates are how far the two tables are apart.
TEST_P(SpdOracleTest, CountsAgreeWithThePublishedOnes) {
    const Published& published = GetParam();
    RAYPICK_REQUIRE_MODEL(std::string("spd/") + published.scene + ".nff");
    const RayCounts rays = traced(published.scene);
    const auto eye_hits = static_cast<double>(rays.eye_hits);
    const auto secondary = static_cast<double>(rays.reflection + rays.refraction);
    const auto shadow = static_cast<double>(rays.shadow);
    EXPECT_EQ(rays.eye, 263169u);
    EXPECT_LE(deviation(eye_hits, published.eye_hits), 0.005) << eye_hits;
    EXPECT_LE(deviation(secondary, published.secondary), 0.04) << secondary;
    EXPECT_LE(deviation(shadow, published.shadow), published.glass ? 0.13 : 0.02) << shadow;
    // Havran alone counts these. In mount he has 0.21 of his shadow rays blocked, we 0.61; the
    // tables don't say how he treats glass in the light's way, so that there is nothing to hold it
    // against.
    if (!published.glass) {
        const auto blocked = static_cast<double>(rays.shadow_blocked);
        EXPECT_LE(std::abs(blocked / published.shadow_blocked - 1.0), 0.02) << blocked;
    }
    RecordProperty("eye_hits", std::to_string(rays.eye_hits));
    RecordProperty("reflection", std::to_string(rays.reflection));
    RecordProperty("refraction", std::to_string(rays.refraction));
    RecordProperty("shadow", std::to_string(rays.shadow));
    RecordProperty("shadow_blocked", std::to_string(rays.shadow_blocked));
}

INSTANTIATE_TEST_SUITE_P(, SpdOracleTest, testing::ValuesIn(kPublished),
                         [](const auto& test) { return std::string(test.param.scene); });

TEST(SpdOracle, EveryEyeRayHitsInClosedScenes) {
    for (const std::string name : {"balls", "rings"}) {
        RAYPICK_REQUIRE_MODEL("spd/" + name + ".nff");
        EXPECT_EQ(traced(name).eye_hits, 263169u) << name;
    }
}

TEST(SpdOracle, GlassReflectsAsOftenAsItRefracts) {
    RAYPICK_REQUIRE_MODEL("spd/mount.nff");
    const RayCounts rays = traced("mount");
    EXPECT_EQ(rays.reflection, rays.refraction);
}

TEST(SpdOracle, NothingReflectsInTetra) {
    RAYPICK_REQUIRE_MODEL("spd/tetra.nff");
    const RayCounts rays = traced("tetra");
    EXPECT_EQ(rays.reflection, 0u);
    EXPECT_EQ(rays.refraction, 0u);
}

}  // namespace
}  // namespace raypick
