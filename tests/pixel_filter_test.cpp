// How samples are weighed that make a pixel.
#include "tracer/render/pixel_filter.h"
#include "tests/trace_shots.h"
#include "tracer/render/render_job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace raypick {
namespace {

constexpr std::array kFilters{PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian,
                              PixelFilter::mitchell};

std::shared_ptr<const Accel> shared_accel(Scene scene) {
    return std::make_shared<const Accel>(accel_of(std::move(scene)));
}

RenderSettings filtered(PixelFilter filter, int samples, Sampling sampling = Sampling::stratified) {
    RenderSettings settings;
    settings.sampling = sampling;
    settings.samples = samples;
    settings.filter = filter;
    return settings;
}

double integral(const std::function<double(double)>& f, double low, double high) {
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
        sum += f(low + (high - low) * (i + 0.5) / kSteps);
    return sum * (high - low) / kSteps;
}

TEST(PixelFilterTest, IntegratesToOneIsEvenAndEndsAtItsRadius) {
    for (const PixelFilter filter : kFilters) {
        SCOPED_TRACE(static_cast<int>(filter));
        const double radius = filter_radius(filter);
        const auto a = [&](double x) { return filter_value(filter, x); };
        EXPECT_NEAR(integral(a, -radius, radius), 1.0, 1e-6);
        EXPECT_EQ(a(radius), 0.0);
        EXPECT_EQ(a(-radius), 0.0);
        EXPECT_NE(a(radius - 1e-3), 0.0);
        for (const double x : {0.1, 0.4, 0.9, 1.3, 1.9})
            EXPECT_EQ(a(x), a(-x));
    }
}

// Mitchell and Netravali's polynomial at points where it is easy to evaluate by hand.
TEST(PixelFilterTest, MitchellByHand) {
    EXPECT_NEAR(filter_value(PixelFilter::mitchell, 0.0), 8.0 / 9.0, 1e-15);
    EXPECT_NEAR(filter_value(PixelFilter::mitchell, 1.0), 1.0 / 18.0, 1e-15);
    EXPECT_NEAR(filter_value(PixelFilter::mitchell, 1.0 - 1e-12), 1.0 / 18.0, 1e-10);
    EXPECT_NEAR(filter_value(PixelFilter::mitchell, 8.0 / 7.0), 0.0, 1e-15);
    EXPECT_NEAR(filter_value(PixelFilter::mitchell, 1.5), -5.0 / 144.0, 1e-15);
}

TEST(PixelFilterTest, PlacesAreAsDenseAsTheFilterIsHigh) {
    for (const PixelFilter filter : kFilters) {
        SCOPED_TRACE(static_cast<int>(filter));
        const FilterSampler sampler(filter);
        const double radius = filter_radius(filter);
        const auto height = [&](double x) { return std::abs(filter_value(filter, x)); };
        const double all = integral(height, -radius, radius);
        double last = -radius;
        for (int i = 0; i <= 100; ++i) {
            const double u = std::min(i / 100.0, 1.0 - 1e-12);
            const FilterOffset at = sampler.sample(u);
            EXPECT_GE(at.offset, last);
            EXPECT_LE(at.offset, radius);
            EXPECT_EQ(at.negative, filter_value(filter, at.offset) < 0.0);
            EXPECT_NEAR(integral(height, -radius, at.offset) / all, u, 1e-4);
            last = at.offset;
        }
        const double lobes = 0.5 * (all - 1.0);
        EXPECT_NEAR(sampler.negative_share(), 2.0 * lobes * (1.0 + lobes), 1e-5);
    }
}

TEST(PixelMeanTest, IsTheFilteredMean) {
    for (const PixelFilter filter : kFilters) {
        const FilterSampler sampler(filter);
        PixelMean mean;
        mean.add({1.0f, 0.0f, 4.0f}, false);
        mean.add({3.0f, 0.0f, 4.0f}, false);
        EXPECT_EQ(mean.colour(sampler), glm::vec3(2.0f, 0.0f, 4.0f));
        mean.add({0.0f, 1.0f, 4.0f}, true);
        const auto share = static_cast<float>(sampler.negative_share());
        EXPECT_FLOAT_EQ(mean.colour(sampler).x, 2.0f + 2.0f * share);
        EXPECT_EQ(mean.colour(sampler).y, 0.0f) << "not below black";
        EXPECT_EQ(mean.colour(sampler).z, 4.0f);
    }
    PixelMean only_negative;
    only_negative.add(glm::vec3(0.7f), true);
    EXPECT_EQ(only_negative.colour(FilterSampler(PixelFilter::mitchell)), glm::vec3(0.7f));
}

TEST(PixelFilterTest, AConstantSceneStaysConstantUnderEveryFilter) {
    Scene scene;
    scene.background = {0.3f, 0.55f, 0.7f};
    const auto accel = shared_accel(std::move(scene));
    for (const PixelFilter filter : kFilters) {
        for (const int samples : {1, 2, 3, 8}) {
            for (const Sampling sampling : {Sampling::stratified, Sampling::adaptive}) {
                const RenderSettings settings = filtered(filter, samples, sampling);
                for (const glm::vec3& colour :
                     render(accel, Camera{}, {9, 11}, settings).image.colour) {
                    ASSERT_EQ(colour, accel->scene().background);
                }
            }
        }
    }
}

// A glowing half plane whose straight edge crosses the columns: pixels show the integral of the
// filter up to the edge.
TEST(PixelFilterTest, AnEdgeIsAsBlurredAsTheFilterSays) {
    Scene scene;
    scene.background = glm::vec3(0.0f);
    const MaterialId white = add_material(scene, glowing_material(glm::vec3(1.0f)));
    place(scene, Box{{0, -50, -2}, {50, 50, -1}}, white);
    const auto accel = shared_accel(std::move(scene));
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.height = 10.0;
    camera.near = 1e-3;
    const ImageSize size{10, 10};  // one pixel a unit; the edge is that of columns 4 and 5
    for (const PixelFilter filter : kFilters) {
        const RenderSettings settings = filtered(filter, 32);
        const Image image = render(accel, camera, size, settings).image;
        for (int col = 2; col < 8; ++col) {
            const double to_edge = 5.0 - (col + 0.5);
            const double wanted =
                integral([&](double x) { return filter_value(filter, x); }, to_edge, 3.0);
            const float got = image.colour[size.index({5, col})].x;
            EXPECT_NEAR(got, std::max(wanted, 0.0), 0.01)
                << static_cast<int>(filter) << " column " << col;
        }
    }
}

// A wall that glows from 0 at the left to 1 at the right, seen in true size: every filter has the
// same weight on both sides of a pixel's centre, so a ramp stays a ramp.
TEST(PixelFilterTest, KeepsARamp) {
    constexpr int kTexels = 256;
    std::vector<glm::u8vec4> texels;
    for (int i = 0; i < kTexels; ++i)
        texels.emplace_back(glm::u8vec3(static_cast<std::uint8_t>(i)), 255);
    Scene scene = dark_scene();
    Texture ramp;
    ramp.source =
        ImageTexture{make_texture_pixels(1, kTexels, std::move(texels), TexelCoding::linear), ""};
    Material glowing = glowing_material(glm::vec3(1.0f));
    glowing.map(MapSlot::emissive).texture = add_texture(scene, std::move(ramp));
    place(scene, Rectangle{{-10, -10, 0}, {20, 0, 0}, {0, 20, 0}}, add_material(scene, glowing));
    const auto accel = shared_accel(std::move(scene));
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.height = 20.0;
    constexpr int kColumns = 20;
    const ImageSize size{kColumns, kColumns};
    for (const PixelFilter filter : kFilters) {
        const Image image = render(accel, camera, size, filtered(filter, 32)).image;
        for (int col = 3; col < kColumns - 3; ++col) {
            // Texel i is i / 255, at (i + 0.5) / 256 of the width.
            const double wanted = ((col + 0.5) / kColumns * kTexels - 0.5) / 255.0;
            double mean = 0.0;
            for (int row = 3; row < kColumns - 3; ++row) {
                const auto got = static_cast<double>(image.colour[size.index({row, col})].x);
                // Where the filter is negative its samples are few: a tenth of a step of noise.
                EXPECT_NEAR(got, wanted, 5e-3) << static_cast<int>(filter) << " column " << col;
                mean += got / (kColumns - 6);
            }
            EXPECT_NEAR(mean, wanted, 5e-4) << static_cast<int>(filter) << " column " << col;
        }
    }
}

}  // namespace
}  // namespace raypick
