// Rays are counted, left out and scattered by rule.
#include "tests/trace_shots.h"
#include "tracer/render/render_job.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace raypick {
namespace {

constexpr ImageSize kSize{36, 48};

// Mirrors, glass and soft shadows: all kinds of rays, and all that is random.
std::shared_ptr<const Accel> mixed_scene() {
    Scene scene;
    scene.background = glm::vec3(0.5f);
    Material mirror = white_material();
    mirror.diffuse = glm::vec3(0.2f);
    mirror.reflect = glm::vec3(0.7f);
    Material glass = glass_material();
    glass.transmit = glm::vec3(0.8f);
    glass.reflect = glm::vec3(0.2f);
    place(scene, Sphere{{-1, 0.1, 0}, 1.0}, add_material(scene, mirror));
    place(scene, Sphere{{1.1, 0, 0.6}, 0.9}, add_material(scene, glass));
    place(scene, Plane{{0, 1, 0}, 1.0}, add_material(scene, mirror));
    scene.lights = {SphereLight{"bulb", {2, 4, 3}, 0.8, glm::vec3(0.4f), {}, 2},
                    RectangleLight{"panel", {-3, 5, 1}, {2, 0, 0}, {0, 0, 2}, glm::vec3(0.4f)}};
    return std::make_shared<const Accel>(accel_of(std::move(scene)));
}

Camera front_camera() {
    Camera camera;
    camera.eye = {0.3, 0.7, 6.0};
    camera.near = 0.01;
    return camera;
}

RenderSettings sampled(Sampling sampling) {
    RenderSettings settings;
    settings.sampling = sampling;
    settings.samples = 2;
    settings.depth = 6;
    return settings;
}

constexpr std::array kSamplings{Sampling::centre, Sampling::corners, Sampling::stratified,
                                Sampling::adaptive};

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// --- counting -----------------------------------------------------------------------------------

TEST(Counts, ByDepthAddUpToTotals) {
    const auto accel = mixed_scene();
    const auto sum = [](const auto& by_depth) {
        return std::accumulate(by_depth.begin(), by_depth.end(), std::uint64_t{0});
    };
    for (const Sampling sampling : kSamplings) {
        const RayCounts rays = render(accel, front_camera(), kSize, sampled(sampling)).rays;
        EXPECT_EQ(sum(rays.reflection_at), rays.reflection);
        EXPECT_EQ(sum(rays.refraction_at), rays.refraction);
        EXPECT_EQ(sum(rays.shadow_at), rays.shadow);
        EXPECT_EQ(rays.total(), rays.eye + rays.reflection + rays.refraction + rays.shadow);
        EXPECT_LE(rays.eye_hits, rays.eye);
        EXPECT_LE(rays.shadow_blocked, rays.shadow);
        // Eye rays are depth 1, and the limit is 6: no secondary ray is of either's neighbour.
        for (const auto& by_depth : {rays.reflection_at, rays.refraction_at}) {
            EXPECT_EQ(by_depth[0] + by_depth[1], 0u);
            EXPECT_GT(by_depth[2], 0u);
            EXPECT_GT(by_depth[6], 0u);
            EXPECT_EQ(by_depth[7], 0u);
        }
        EXPECT_GT(rays.shadow_at[1], 0u);
        EXPECT_GT(rays.shadow_at[6], 0u);
        EXPECT_EQ(rays.shadow_at[7], 0u);
    }
}

// Sheets that mirror and let through one half each: one sends one ray each way.
TEST(Counts, OfAMirroringVeilByHand) {
    Scene scene = dark_scene();
    Material half = glass_material(1.0f);
    half.reflect = half.transmit = glm::vec3(0.5f);
    half.thin_walled = true;
    const MaterialId id = add_material(scene, half);
    const Ray ray = ray_towards({0, 0, 5}, {0, 0, 0});
    RenderSettings settings;
    settings.depth = 5;
    place(scene, Plane{{0, 0, 1}, 0.0}, id);
    const Shot one = shoot(scene, ray, settings);
    EXPECT_EQ(one.counts.reflection, 1u);
    EXPECT_EQ(one.counts.refraction, 1u);
    // Between two sheets one ray goes back and forth; at each hit it sends one out.
    place(scene, Plane{{0, 0, 1}, 1.0}, id);
    const Shot two = shoot(scene, ray, settings);
    for (std::size_t depth = 2; depth <= 5; ++depth) {
        EXPECT_EQ(two.counts.reflection_at[depth], 1u);
        EXPECT_EQ(two.counts.refraction_at[depth], 1u);
    }
}

// --- the cutoff ---------------------------------------------------------------------------------

// A ray that is left out would have brought no more than the cutoff times the brightest there is:
// without lights the background's 0.5, since the materials give back no more than they get.
TEST(Cutoff, ChangesNoPixelByMoreThanWhatItLeavesOut) {
    const auto accel = mixed_scene();
    RenderSettings all = sampled(Sampling::centre);
    all.depth = 9;
    all.cutoff = 0.0f;
    std::uint64_t last = 0;
    for (const float cutoff : {0.2f, 0.05f, 0.01f, 1e-3f}) {
        RenderSettings some = all;
        some.cutoff = cutoff;
        std::uint64_t shot = 0;
        std::uint64_t of_all = 0;
        int changed = 0;
        for (int i = 0; i < 400; ++i) {
            const Pixel pixel{(i / 20) + 8, (i % 20) * 2 + 4};
            const EyeRay eye{
                camera_ray(front_camera(), kSize, pixel), {}, static_cast<std::uint64_t>(i)};
            RayCounts few;
            RayCounts many;
            const glm::vec3 a = trace(*accel, {}, some, eye, few).colour;
            const glm::vec3 b = trace(*accel, {}, all, eye, many).colour;
            const auto left_out = static_cast<float>(many.total() - few.total());
            for (int k = 0; k < 3; ++k)
                EXPECT_LE(std::abs(a[k] - b[k]), 0.5f * cutoff * left_out + 1e-6f)
                    << cutoff << ' ' << i;
            changed += many.total() != few.total() ? 1 : 0;
            shot += few.total();
            of_all += many.total();
        }
        EXPECT_LT(shot, of_all);
        EXPECT_GT(shot, last) << "a lower cutoff leaves out less";
        EXPECT_GT(changed, 50);
        last = shot;
    }
}

// A corridor of walls that mirror half: with a cutoff of 2^-k the ray of weight 2^-k is the first
// to be left out, and all behind it would have added 2^-k * 2.
TEST(Cutoff, EndsACorridorWhereItSays) {
    Scene scene = dark_scene();
    Material wall = glowing_material(glm::vec3(1.0f));
    wall.reflect = glm::vec3(0.5f);
    const MaterialId id = add_material(scene, wall);
    place(scene, Plane{{0, 0, 1}, 1.0}, id);
    place(scene, Plane{{0, 0, -1}, 1.0}, id);
    RenderSettings settings;
    settings.depth = kMaxDepth;
    for (int k = 1; k <= 12; ++k) {
        settings.cutoff = std::ldexp(1.0f, -k);
        const Shot shot = shoot(scene, Ray{}, settings);
        EXPECT_EQ(shot.counts.reflection, static_cast<std::uint64_t>(k - 1));
        expect_colour(shot.traced.colour, glm::dvec3(2.0 - std::ldexp(1.0, 1 - k)));
    }
    settings.cutoff = 0.0f;
    EXPECT_EQ(shoot(scene, Ray{}, settings).counts.reflection,
              static_cast<std::uint64_t>(kMaxDepth - 1));
}

// Off, even rays that bring nothing are shot: the rule of the published counts.
TEST(Cutoff, OffMeansEveryRay) {
    Scene scene = dark_scene();
    Material one_sided = black_material();
    one_sided.transmit = glm::vec3(1.0f);  // reflects nothing, but is of a kind that might
    one_sided.ior = 1.0f;
    place(scene, Plane{{0, 0, 1}, 0.0}, add_material(scene, one_sided));
    const Ray ray = ray_towards({0, 0, 5}, {0, 0, 0});
    RenderSettings settings;
    EXPECT_EQ(shoot(scene, ray, settings).counts.reflection, 0u);
    settings.cutoff = 0.0f;
    EXPECT_EQ(shoot(scene, ray, settings).counts.reflection, 1u);
}

// --- chance -------------------------------------------------------------------------------------

TEST(Chance, OneTwoAndFiveThreadsGiveTheSameBits) {
    const auto accel = mixed_scene();
    for (const Sampling sampling : kSamplings) {
        RenderSettings settings = sampled(sampling);
        settings.threads = 1;
        const RenderedFrame one = render(accel, front_camera(), kSize, settings);
        for (const int threads : {2, 5}) {
            settings.threads = threads;
            const RenderedFrame many = render(accel, front_camera(), kSize, settings);
            EXPECT_TRUE(same_bits(many.image.colour, one.image.colour));
            EXPECT_EQ(many.rays, one.rays);
            RenderJob watched(accel, front_camera(), kSize, settings);
            watched.wait();
            FrameSnapshot frame;
            ASSERT_TRUE(watched.snapshot(frame));
            EXPECT_TRUE(same_bits(frame.image.colour, one.image.colour));
            EXPECT_EQ(watched.progress().rays.shadow_blocked, one.rays.shadow_blocked);
        }
    }
}

// Another seed is another noise, but the same picture in the mean.
TEST(Chance, AnotherSeedIsAnotherNoise) {
    const auto accel = mixed_scene();
    for (const Sampling sampling : kSamplings) {
        RenderSettings settings = sampled(sampling);
        const auto mean_of = [&](std::uint64_t seed) {
            settings.seed = seed;
            return render(accel, front_camera(), kSize, settings).image.colour;
        };
        const std::vector<glm::vec3> a = mean_of(1);
        const std::vector<glm::vec3> b = mean_of(2);
        EXPECT_TRUE(same_bits(a, mean_of(1)));
        std::size_t differ = 0;
        double gap = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            differ += a[i] != b[i] ? 1 : 0;
            gap += static_cast<double>(a[i].x - b[i].x);
        }
        EXPECT_GT(differ, a.size() / 4);
        EXPECT_LT(std::abs(gap) / static_cast<double>(a.size()), 2e-3);
    }
}

}  // namespace
}  // namespace raypick
