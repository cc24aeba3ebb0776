// Where a pixel's rays go, and what becomes of what they bring back.
#include "tests/random.h"
#include "tests/tracer_scenes.h"
#include "tracer/error.h"
#include "tracer/geometry/unit_disk.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/render_job.h"
#include "tracer/render/sampling_pattern.h"
#include "tracer/render/tiles.h"
#include "tracer/shade/trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <thread>

namespace raypick {
namespace {

constexpr ImageSize kSize{61, 83};

std::shared_ptr<const Accel> shared_accel(Scene scene) {
    return std::make_shared<const Accel>(accel_of(std::move(scene)));
}

// A red ball before a green wall, with a mirror and shadows: edges of every kind.
std::shared_ptr<const Accel> ball_scene() {
    Scene scene;
    Material red;
    red.diffuse = {0.9f, 0.1f, 0.1f};
    Material mirror = black_material();
    mirror.reflect = glm::vec3(0.8f);
    place(scene, Sphere{{0.3, 0.2, 0.0}, 1.0}, add_material(scene, red));
    place(scene, Sphere{{-1.4, -0.3, 0.5}, 0.6}, add_material(scene, mirror));
    place(scene, Plane{{0, 1, 0}, 1.0});
    scene.lights = {PointLight{"lamp", {3, 5, 4}, glm::vec3(0.8f)}};
    return shared_accel(std::move(scene));
}

Camera ball_camera() {
    Camera camera;
    camera.eye = {0.4, 0.9, 5.0};
    camera.near = 0.01;
    return camera;
}

RenderSettings sampled(Sampling sampling, int samples = 3, PixelFilter filter = PixelFilter::box) {
    RenderSettings settings;
    settings.sampling = sampling;
    settings.samples = samples;
    settings.filter = filter;
    return settings;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same(const Image& a, const Image& b) {
    EXPECT_TRUE(same_bits(a.colour, b.colour));
    EXPECT_TRUE(same_bits(a.depth, b.depth));
    EXPECT_TRUE(same_bits(a.normal, b.normal));
    EXPECT_TRUE(same_bits(a.object, b.object));
    EXPECT_TRUE(same_bits(a.primitive, b.primitive));
}

Image watched_to_the_end(const std::shared_ptr<const Accel>& accel,
                         const RenderSettings& settings) {
    RenderJob job(accel, ball_camera(), kSize, settings);
    job.wait();
    FrameSnapshot frame;
    job.snapshot(frame);
    return frame.image;
}

TEST(SamplingPatternTest, ShufflesAreShuffles) {
    for (const std::uint32_t count : {1u, 2u, 4u, 9u, 16u, 25u, 63u * 63u, 64u * 64u}) {
        std::set<std::uint32_t> seen;
        bool moved = false;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t to = shuffled(i, count, 77);
            EXPECT_LT(to, count);
            seen.insert(to);
            moved |= to != i;
        }
        EXPECT_EQ(seen.size(), count);
        EXPECT_TRUE(moved || count < 3);
    }
    int differ = 0;
    for (std::uint64_t key = 0; key < 100; ++key)
        differ += shuffled(0, 16, key) != shuffled(0, 16, key + 1) ? 1 : 0;
    EXPECT_GT(differ, 80);
}

// The first sample of a pixel lies in any cell with the same probability: the picture of the first
// pass is not shifted.
TEST(SamplingPatternTest, TheFirstSamplesAreNotShifted) {
    const SamplingPattern pattern(sampled(Sampling::stratified, 4));
    constexpr std::uint64_t kPixels = 20000;
    std::array<int, 16> cells{};
    glm::dvec2 sum{0.0};
    for (std::uint64_t pixel = 0; pixel < kPixels; ++pixel) {
        const glm::dvec2 at = pattern.sample(pixel, 0).offset + 0.5;
        ++cells[static_cast<std::size_t>(at.x * 4) + 4 * static_cast<std::size_t>(at.y * 4)];
        sum += at;
    }
    EXPECT_NEAR(sum.x / kPixels, 0.5, 0.01);
    EXPECT_NEAR(sum.y / kPixels, 0.5, 0.01);
    for (const int count : cells)
        EXPECT_NEAR(count, kPixels / 16.0, 200.0);
}

TEST(SamplingPatternTest, OneSampleInEachCellOfPixelAndLens) {
    for (const int side : {1, 2, 3, 8}) {
        SCOPED_TRACE(side);
        const SamplingPattern pattern(sampled(Sampling::stratified, side));
        ASSERT_EQ(pattern.count(), side * side);
        for (const std::uint64_t pixel : {0u, 1u, 12345u}) {
            std::set<std::pair<int, int>> cells;
            std::set<std::uint64_t> seeds;
            glm::dvec2 lens_sum{0.0};
            for (int i = 0; i < pattern.count(); ++i) {
                const PixelSample sample = pattern.sample(pixel, i);
                EXPECT_LE(std::abs(sample.offset.x), 0.5);
                EXPECT_LE(std::abs(sample.offset.y), 0.5);
                EXPECT_LE(glm::length(sample.lens), 1.0 + 1e-12);
                EXPECT_FALSE(sample.negative);
                cells.emplace(static_cast<int>((sample.offset.x + 0.5) * side),
                              static_cast<int>((sample.offset.y + 0.5) * side));
                seeds.insert(sample.seed);
                lens_sum += sample.lens;
            }
            EXPECT_EQ(cells.size(), static_cast<std::size_t>(side * side));
            EXPECT_EQ(seeds.size(), static_cast<std::size_t>(side * side));
            // 64 cells of the lens leave no room for their mean to stray.
            EXPECT_LT(glm::length(lens_sum) / (side * side), side == 8 ? 0.05 : 1.0);
        }
    }
}

TEST(SamplingPatternTest, TheDiskIsFilledEvenly) {
    Random random(3);
    constexpr int kCount = 40000;
    std::array<int, 4> rings{};  // of equal area
    std::array<int, 8> octants{};
    for (int i = 0; i < kCount; ++i) {
        const glm::dvec2 p = disk_from_square({random.unit(), random.unit()});
        const double r2 = glm::dot(p, p);
        ASSERT_LE(r2, 1.0 + 1e-12);
        ++rings[std::min<std::size_t>(3, static_cast<std::size_t>(4.0 * r2))];
        const double turn = (std::atan2(p.y, p.x) + M_PI) / (2.0 * M_PI);
        ++octants[std::min<std::size_t>(7, static_cast<std::size_t>(8.0 * turn))];
    }
    for (const int count : rings)
        EXPECT_NEAR(count, kCount / 4.0, 400.0);
    for (const int count : octants)
        EXPECT_NEAR(count, kCount / 8.0, 300.0);
    EXPECT_EQ(disk_from_square({0.5, 0.5}), glm::dvec2(0.0));
}

TEST(SamplingTest, ImagesDependNeitherOnThreadsNorOnBeingWatched) {
    const auto accel = ball_scene();
    for (const Sampling sampling :
         {Sampling::centre, Sampling::corners, Sampling::stratified, Sampling::adaptive}) {
        for (const PixelFilter filter : {PixelFilter::box, PixelFilter::mitchell}) {
            RenderSettings settings = sampled(sampling, 3, filter);
            settings.aperture = sampling == Sampling::stratified ? 0.2 : 0.0;
            settings.threads = 1;
            const RenderedFrame one = render(accel, ball_camera(), kSize, settings);
            EXPECT_EQ(one.nan_pixels, 0u);
            for (const int threads : {2, 3, 8}) {
                SCOPED_TRACE(testing::Message() << static_cast<int>(sampling) << ' ' << threads);
                settings.threads = threads;
                const RenderedFrame many = render(accel, ball_camera(), kSize, settings);
                expect_same(many.image, one.image);
                EXPECT_EQ(many.rays, one.rays);
                expect_same(watched_to_the_end(accel, settings), one.image);
            }
        }
    }
}

TEST(SamplingTest, TheSeedDecidesTheNoiseAndNothingElse) {
    const auto accel = ball_scene();
    RenderSettings settings = sampled(Sampling::stratified, 2);
    const Image zero = render(accel, ball_camera(), kSize, settings).image;
    settings.seed = 1;
    const Image one = render(accel, ball_camera(), kSize, settings).image;
    EXPECT_FALSE(same_bits(zero.colour, one.colour));
    EXPECT_TRUE(same_bits(zero.object, one.object));
    EXPECT_TRUE(same_bits(zero.depth, one.depth));
    settings.seed = 0;
    expect_same(render(accel, ball_camera(), kSize, settings).image, zero);
}

// What a pick hits is what the frame's other channels say, however its colours are sampled.
TEST(SamplingTest, IdsDepthAndNormalsAreThoseOfTheCentre) {
    const auto accel = ball_scene();
    const Image centre = render(accel, ball_camera(), kSize, {}).image;
    for (const Sampling sampling : {Sampling::corners, Sampling::stratified, Sampling::adaptive}) {
        const Image image = render(accel, ball_camera(), kSize, sampled(sampling, 2)).image;
        EXPECT_TRUE(same_bits(image.object, centre.object));
        EXPECT_TRUE(same_bits(image.primitive, centre.primitive));
        EXPECT_TRUE(same_bits(image.depth, centre.depth));
        EXPECT_TRUE(same_bits(image.normal, centre.normal));
        EXPECT_FALSE(same_bits(image.colour, centre.colour));
    }
}

TEST(SamplingTest, CornersAreSharedAndCounted) {
    const auto accel = ball_scene();
    const Camera camera = ball_camera();
    const RenderSettings settings = sampled(Sampling::corners);
    const RenderedFrame frame = render(accel, camera, kSize, settings);
    EXPECT_EQ(frame.rays.eye, 62u * 84u);
    const std::vector<Light> lights = effective_lights(accel->scene(), camera);
    RayCounts counts;
    std::vector<glm::vec3> corners;
    for (int r = 0; r <= kSize.rows; ++r) {
        for (int c = 0; c <= kSize.cols; ++c) {
            const ImagePoint point{static_cast<double>(r), static_cast<double>(c)};
            const Ray ray = camera_ray(camera, kSize, point);
            corners.push_back(trace(*accel, lights, settings, ray, counts).colour);
        }
    }
    EXPECT_EQ(frame.rays, counts);
    const ImageSize grid{kSize.rows + 1, kSize.cols + 1};
    for (int row = 0; row < kSize.rows; ++row) {
        for (int col = 0; col < kSize.cols; ++col) {
            const glm::vec3 sum =
                corners[grid.index({row, col})] + corners[grid.index({row, col + 1})] +
                corners[grid.index({row + 1, col})] + corners[grid.index({row + 1, col + 1})];
            ASSERT_LT(glm::distance(frame.image.colour[kSize.index({row, col})], 0.25f * sum),
                      1e-6f);
        }
    }
}

TEST(SamplingTest, ThePublishedNumberOfEyeRays) {
    Scene scene;
    place(scene, Sphere{{0, 0, 0}, 1.0});
    const auto accel = shared_accel(std::move(scene));
    EXPECT_EQ(render(accel, Camera{}, {512, 512}, sampled(Sampling::corners)).rays.eye, 263169u);
}

TEST(SamplingTest, AdaptiveIsTheCentreWhereItIsFlatAndStratifiedWhereItIsNot) {
    const auto accel = ball_scene();
    for (const PixelFilter filter : {PixelFilter::box, PixelFilter::mitchell}) {
        const RenderSettings settings = sampled(Sampling::adaptive, 4, filter);
        const Image centre = render(accel, ball_camera(), kSize, {}).image;
        const RenderedFrame all =
            render(accel, ball_camera(), kSize, sampled(Sampling::stratified, 4, filter));
        const RenderedFrame frame = render(accel, ball_camera(), kSize, settings);
        const Tile whole{0, kSize.rows, 0, kSize.cols};
        const int reach = filter == PixelFilter::mitchell ? 2 : 1;
        const auto refined = contrasting_pixels(centre, whole, reach, settings.contrast);
        std::size_t count = 0;
        for (std::size_t i = 0; i < refined.size(); ++i) {
            count += refined[i];
            ASSERT_EQ(frame.image.colour[i],
                      (refined[i] != 0 ? all : RenderedFrame{centre, {}}).image.colour[i]);
        }
        EXPECT_GT(count, refined.size() / 50);
        EXPECT_LT(count, refined.size() / 2);
        EXPECT_EQ(frame.rays.eye, refined.size() + 16 * count);
    }
}

TEST(SamplingTest, ContrastIsJudgedAsSeen) {
    Image image = make_image({3, 5});
    const auto chosen = [&](int reach, float contrast) {
        return contrasting_pixels(image, {0, 3, 0, 5}, reach, contrast);
    };
    EXPECT_EQ(chosen(1, 0.0f), std::vector<std::uint8_t>(15, 0));
    image.colour[image.size.index({1, 4})] = glm::vec3(0.0f, 0.214f, 0.0f);  // half in sRGB
    EXPECT_EQ(chosen(1, 0.49f),
              (std::vector<std::uint8_t>{0, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 1}));
    EXPECT_EQ(chosen(1, 0.51f), std::vector<std::uint8_t>(15, 0));
    EXPECT_EQ(chosen(2, 0.49f),
              (std::vector<std::uint8_t>{0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 0, 0, 1, 1, 1}));
    // Brighter than white is white.
    image.colour.assign(15, glm::vec3(1.0f));
    image.colour[7] = glm::vec3(20.0f);
    EXPECT_EQ(chosen(1, 0.0f), std::vector<std::uint8_t>(15, 0));
}

TEST(SamplingTest, PassesAreCountedAndTheImageConverges) {
    const auto accel = ball_scene();
    RenderSettings settings = sampled(Sampling::stratified, 6);
    settings.threads = 1;
    const Image wanted = render(accel, ball_camera(), kSize, settings).image;
    RenderJob job(accel, ball_camera(), kSize, settings);
    EXPECT_EQ(job.progress().passes, 36);
    FrameSnapshot frame;
    int last_pass = 0;
    double first_error = -1.0;
    double error = 0.0;
    for (RenderProgress progress = job.progress();; progress = job.progress()) {
        EXPECT_GE(progress.pass, last_pass);
        EXPECT_LE(progress.pass, 36);
        last_pass = progress.pass;
        if (progress.pass > 1 && job.snapshot(frame)) {
            error = 0.0;
            for (std::size_t i = 0; i < wanted.colour.size(); ++i)
                error += glm::distance(frame.image.colour[i], wanted.colour[i]);
            if (first_error < 0.0) first_error = error;
        }
        if (progress.finished) break;
    }
    job.wait();
    job.snapshot(frame);
    EXPECT_EQ(job.progress().fraction, 1.0);
    EXPECT_EQ(job.progress().pass, 36);
    EXPECT_EQ(job.progress().rays.eye, 36 * kSize.pixel_count());
    expect_same(frame.image, wanted);
    EXPECT_GT(first_error, 0.0);
}

TEST(SamplingTest, ACancelledRefinementKeepsWhatItHas) {
    const auto accel = ball_scene();
    RenderJob job(accel, ball_camera(), {300, 400}, sampled(Sampling::stratified, 64));
    while (job.progress().pass < 2)
        std::this_thread::yield();
    job.cancel();
    job.wait();
    EXPECT_TRUE(job.progress().cancelled);
    FrameSnapshot frame;
    ASSERT_TRUE(job.snapshot(frame));
    EXPECT_EQ(std::count(frame.traced.begin(), frame.traced.end(), 0), 0);
}

// Numbers that are fine by themselves, but whose sum is too large for a float.
TEST(SamplingTest, PixelsThatAreNoNumberAreBlackAndCounted) {
    Scene scene;
    // The brightest of lights on the brightest of surfaces is more than a float holds.
    Material bad = black_material();
    bad.diffuse = {1.0f, 1e6f, 1.0f};
    PointLight light;
    light.position = Camera{}.eye;
    light.colour = glm::vec3(1e18f);
    light.attenuation = {1e-18, 0.0, 0.0};
    scene.lights = {light};
    place(scene, Sphere{{0, 0, 0}, 1.0}, add_material(scene, bad));
    const auto accel = shared_accel(std::move(scene));
    const ImageSize size{21, 21};
    const Image centre = render(accel, Camera{}, size, {}).image;
    const auto hits =
        static_cast<std::uint64_t>(std::count(centre.object.begin(), centre.object.end(), 0u));
    ASSERT_GT(hits, 10u);
    EXPECT_EQ(render(accel, Camera{}, size, {}).nan_pixels, hits);
    for (const Sampling sampling : {Sampling::corners, Sampling::stratified, Sampling::adaptive}) {
        const RenderedFrame frame = render(accel, Camera{}, size, sampled(sampling, 2));
        EXPECT_GE(frame.nan_pixels, hits / 2);
        std::uint64_t black = 0;
        for (const glm::vec3& colour : frame.image.colour) {
            ASSERT_TRUE(std::isfinite(colour.x) && std::isfinite(colour.y));
            if (colour == glm::vec3(0.0f)) ++black;
        }
        EXPECT_EQ(black, frame.nan_pixels);
        RenderJob job(accel, Camera{}, size, sampled(sampling, 2));
        job.wait();
        EXPECT_EQ(job.progress().nan_pixels, frame.nan_pixels);
    }
}

TEST(SamplingTest, BadSettingsAreErrors) {
    const auto accel = ball_scene();
    const auto refused = [&](const std::function<void(RenderSettings&)>& spoil) {
        RenderSettings settings;
        spoil(settings);
        EXPECT_THROW(RenderJob(accel, ball_camera(), kSize, settings), Error);
    };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    refused([](RenderSettings& s) { s.samples = 0; });
    refused([](RenderSettings& s) { s.samples = 65; });
    refused([](RenderSettings& s) { s.contrast = -0.1f; });
    refused([](RenderSettings& s) { s.contrast = 1.1f; });
    refused([](RenderSettings& s) { s.aperture = -1.0; });
    refused([](RenderSettings& s) { s.aperture = kNaN; });
    refused([](RenderSettings& s) { s.focus_distance = -1.0; });
    refused([](RenderSettings& s) { s.focus_distance = 1.0 / 0.0; });
    refused([](RenderSettings& s) { s.cutoff = -1.0f; });
}

}  // namespace
}  // namespace raypick
