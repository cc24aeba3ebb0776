// The frame in the making; runs under ThreadSanitizer too.
#include "tracer/render/render_job.h"

#include "tests/sanitized.h"
#include "tests/tracer_scenes.h"
#include "tracer/error.h"
#include "tracer/shade/trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace raypick {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// A bit of everything: mesh, mirror, glass, floor, two lights.
Scene mixed_scene() {
    Scene scene;
    Material mirror = black_material();
    mirror.reflect = glm::vec3(0.8f);
    Material glass = black_material();
    glass.transmit = glm::vec3(0.9f);
    glass.reflect = glm::vec3(0.1f);
    Material red;
    red.diffuse = {0.8f, 0.1f, 0.1f};
    red.specular = glm::vec3(0.5f);
    place(scene, Plane{{0, 1, 0}, 1.0});
    place(scene, Sphere{{-1.5, 0, 0}, 1.0}, add_material(scene, mirror));
    place(scene, Sphere{{0.8, -0.2, 1.2}, 0.8}, add_material(scene, glass));
    place_mesh(scene, ball_data(3), add_material(scene, red), translate({1.5, 0.2, -1.5}));
    scene.lights = {PointLight{"lamp", {3, 5, 4}, glm::vec3(0.7f)},
                    DirectionalLight{"sun", {1, -2, -1}, glm::vec3(0.4f)}};
    return scene;
}

// Two parallel mirrors: a ray between them lives as long as the depth allows.
Scene endless_scene() {
    Scene scene;
    Material mirror = black_material();
    mirror.reflect = glm::vec3(0.999f);
    const MaterialId id = add_material(scene, mirror);
    place(scene, Plane{{0, 0, 1}, 6.0}, id);
    place(scene, Plane{{0, 0, -1}, 6.0}, id);
    return scene;
}

std::shared_ptr<const Accel> shared_accel(Scene scene) {
    return std::make_shared<const Accel>(accel_of(std::move(scene)));
}

Camera mixed_camera() {
    Camera camera;
    camera.eye = {0.5, 1.5, 6.0};
    camera.at = {0.0, 0.0, 0.0};
    camera.near = 0.01;
    return camera;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same(const Image& a, const Image& b) {
    EXPECT_EQ(a.size, b.size);
    EXPECT_TRUE(same_bits(a.colour, b.colour));
    EXPECT_TRUE(same_bits(a.depth, b.depth));
    EXPECT_TRUE(same_bits(a.normal, b.normal));
    EXPECT_TRUE(same_bits(a.object, b.object));
    EXPECT_TRUE(same_bits(a.primitive, b.primitive));
}

constexpr ImageSize kOdd{97, 131};

TEST(RenderJob, TheImageIsTheSameForAnyNumberOfThreads) {
    const auto accel = shared_accel(mixed_scene());
    RenderSettings settings;
    settings.threads = 1;
    const RenderedFrame one = render(accel, mixed_camera(), kOdd, settings);
    EXPECT_EQ(one.rays.eye, kOdd.pixel_count());
    EXPECT_GT(one.rays.reflection, 100u);
    EXPECT_GT(one.rays.refraction, 100u);
    for (const int threads : {2, 3, 7, 0}) {
        SCOPED_TRACE(threads);
        settings.threads = threads;
        const RenderedFrame many = render(accel, mixed_camera(), kOdd, settings);
        expect_same(many.image, one.image);
        EXPECT_EQ(many.rays, one.rays);
    }
}

TEST(RenderJob, PixelsAreWhatTracingAndPickingThemSays) {
    const auto accel = shared_accel(mixed_scene());
    const Camera camera = mixed_camera();
    const RenderSettings settings;
    const Image image = render(accel, camera, kOdd, settings).image;
    const std::vector<Light> lights = effective_lights(accel->scene(), camera);
    RayCounts counts;
    int background = 0;
    for (int row = 0; row < kOdd.rows; ++row) {
        for (int col = 0; col < kOdd.cols; ++col) {
            const Pixel pixel{row, col};
            const std::size_t i = kOdd.index(pixel);
            const Ray ray = camera_ray(camera, kOdd, pixel);
            const TracedRay traced = trace(*accel, lights, settings, ray, counts);
            ASSERT_EQ(image.colour[i], traced.colour) << row << ' ' << col;
            const std::optional<Hit> pick = accel->intersect(ray);
            ASSERT_EQ(image.object[i], pick ? pick->object : kNoObject) << row << ' ' << col;
            if (!pick) {
                ++background;
                ASSERT_EQ(image.primitive[i], 0xffffffffu);
                ASSERT_EQ(image.normal[i], glm::vec3(0.0f));
                ASSERT_TRUE(std::isinf(image.depth[i]));
                ASSERT_EQ(image.colour[i], accel->scene().background);
            } else {
                ASSERT_EQ(image.primitive[i], pick->primitive);
                ASSERT_EQ(image.depth[i], pick->t);
                ASSERT_EQ(image.normal[i], traced.normal);
            }
        }
    }
    EXPECT_GT(background, 100);
    EXPECT_EQ(counts, render(accel, camera, kOdd, settings).rays);
}

TEST(RenderJob, TheNearPlaneCuts) {
    Scene scene;
    place(scene, Sphere{{0, 0, 3}, 0.5});
    place(scene, Sphere{{0, 0, 0}, 1.0});
    Camera camera;
    camera.near = 0.01;
    const ImageSize size{9, 9};
    const auto accel = shared_accel(scene);
    EXPECT_EQ(render(accel, camera, size, {}).image.object[size.index({4, 4})], 0u);
    camera.near = 3.0;
    EXPECT_EQ(render(accel, camera, size, {}).image.object[size.index({4, 4})], 1u);
}

TEST(RenderJob, ASceneWithoutLightsHasAHeadlight) {
    Scene scene;
    place(scene, Sphere{});
    const ImageSize size{9, 9};
    Camera camera;
    camera.near = 0.01;
    const Image image = render(shared_accel(scene), camera, size, {}).image;
    EXPECT_GT(image.colour[size.index({4, 4})].x, 0.3f);
}

TEST(RenderJob, OddAndTinySizes) {
    const auto accel = shared_accel(mixed_scene());
    for (const ImageSize size : {ImageSize{1, 1}, ImageSize{1, 40}, ImageSize{40, 1},
                                 ImageSize{7, 9}, ImageSize{33, 32}, ImageSize{65, 3}}) {
        RenderJob job(accel, mixed_camera(), size, {});
        job.wait();
        EXPECT_EQ(job.size(), size);
        EXPECT_EQ(job.progress().fraction, 1.0);
        EXPECT_EQ(job.progress().rays.eye, size.pixel_count());
        FrameSnapshot frame;
        EXPECT_TRUE(job.snapshot(frame));
        expect_same(frame.image, render(accel, mixed_camera(), size, {}).image);
    }
}

TEST(RenderJob, BadCamerasAndSizesAreErrors) {
    const auto accel = shared_accel(mixed_scene());
    Camera camera = mixed_camera();
    EXPECT_THROW(RenderJob(accel, camera, {0, 10}, {}), Error);
    EXPECT_THROW(RenderJob(accel, camera, {10, 0}, {}), Error);
    EXPECT_THROW(RenderJob(accel, camera, {-3, -3}, {}), Error);
    camera.at = camera.eye;
    EXPECT_THROW(RenderJob(accel, camera, {10, 10}, {}), Error);
    EXPECT_THROW(render(accel, camera, {10, 10}, {}), Error);
}

TEST(RenderJob, ProgressGrowsToOne) {
    RenderJob job(shared_accel(mixed_scene()), mixed_camera(), {240, 320}, {});
    RenderProgress last;
    FrameSnapshot frame;
    int changes = 0;
    for (;;) {
        const RenderProgress now = job.progress();
        EXPECT_GE(now.fraction, last.fraction);
        EXPECT_LE(now.fraction, 1.0);
        EXPECT_GE(now.version, last.version);
        EXPECT_GE(now.seconds, last.seconds);
        EXPECT_GE(now.rays.eye, last.rays.eye);
        const std::uint64_t before = frame.version;
        if (job.snapshot(frame)) {
            ++changes;
            EXPECT_GT(frame.version, before);
            EXPECT_EQ(frame.size, (ImageSize{240, 320}));
        } else {
            EXPECT_EQ(frame.version, before);
        }
        last = now;
        if (now.finished) break;
        std::this_thread::sleep_for(milliseconds(1));
    }
    job.wait();
    EXPECT_EQ(last.fraction, 1.0);
    EXPECT_FALSE(last.cancelled);
    EXPECT_GT(changes, 0);
    EXPECT_EQ(last.rays.eye, 240u * 320u);
    const double seconds = job.progress().seconds;
    std::this_thread::sleep_for(milliseconds(5));
    EXPECT_EQ(job.progress().seconds, seconds) << "the clock stops at the end";
    job.snapshot(frame);
    EXPECT_FALSE(job.snapshot(frame)) << "nothing new";
}

TEST(RenderJob, TheCoarseImageComesFirst) {
    // Slow enough that the coarse image is seen on its own.
    RenderSettings settings;
    settings.depth = 200;
    RenderJob job(shared_accel(endless_scene()), Camera{}, {320, 320}, settings);
    FrameSnapshot frame;
    const auto give_up = Clock::now() + std::chrono::seconds(60);
    while (!job.snapshot(frame) && Clock::now() < give_up && !job.progress().finished) {
        std::this_thread::sleep_for(milliseconds(1));
    }
    ASSERT_GT(frame.version, 0u);
    const auto& objects = frame.image.object;
    EXPECT_EQ(std::count(objects.begin(), objects.end(), kNoObject), 0)
        << "no piece of it is shown before the whole";
    EXPECT_LT(job.progress().fraction, 0.5) << "the whole view stood long before the end";
}

RenderPlan coarse_by(int step) {
    RenderPlan plan;
    plan.coarse_step = step;
    return plan;
}

// What a job shows that was stopped at its coarse image.
FrameSnapshot coarse_frame(const std::shared_ptr<const Accel>& accel, RenderPlan plan) {
    RenderJob* self = nullptr;
    std::mutex made;
    std::unique_lock lock(made);
    plan.on_coarse = [&] {
        const std::lock_guard wait(made);
        self->cancel();
    };
    RenderJob job(accel, mixed_camera(), kOdd, {}, plan);
    self = &job;
    lock.unlock();
    job.wait();
    FrameSnapshot frame;
    EXPECT_TRUE(job.snapshot(frame));
    EXPECT_TRUE(frame.traced.empty());
    EXPECT_GT(job.progress().coarse_seconds, 0.0);
    return frame;
}

TEST(RenderJob, TheImageIsTheSameForAnyCoarseImageBeforeIt) {
    const auto accel = shared_accel(mixed_scene());
    const std::vector<int> steps =
        is_sanitized() ? std::vector{1, 5, 200} : std::vector{1, 2, 3, 5, 8, 13, 16, 200};
    for (const Sampling sampling :
         {Sampling::centre, Sampling::corners, Sampling::stratified, Sampling::adaptive}) {
        RenderSettings settings;
        settings.sampling = sampling;
        settings.samples = 2;
        const RenderedFrame wanted = render(accel, mixed_camera(), kOdd, settings);
        for (const int step : steps) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(sampling) << ' ' << step);
            RenderJob job(accel, mixed_camera(), kOdd, settings, coarse_by(step));
            job.wait();
            EXPECT_EQ(job.progress().rays, wanted.rays) << "no ray is traced twice";
            FrameSnapshot frame;
            ASSERT_TRUE(job.snapshot(frame));
            expect_same(frame.image, wanted.image);
            expect_same(frame.whole(), wanted.image);
        }
    }
}

TEST(RenderJob, AnImageOfColourAloneHasTheSameColours) {
    const auto accel = shared_accel(mixed_scene());
    for (const Sampling sampling :
         {Sampling::centre, Sampling::corners, Sampling::stratified, Sampling::adaptive}) {
        RenderSettings settings;
        settings.sampling = sampling;
        settings.samples = 2;
        const RenderedFrame wanted = render(accel, mixed_camera(), kOdd, settings);
        Image colour{kOdd, wanted.image.colour, {}, {}, {}, {}};
        const RenderedFrame frame = render(accel, mixed_camera(), kOdd, settings, Channels::colour);
        expect_same(frame.image, colour);
        EXPECT_EQ(frame.rays, wanted.rays);

        RenderPlan plan = coarse_by(5);
        plan.channels = Channels::colour;
        RenderJob job(accel, mixed_camera(), kOdd, settings, plan);
        job.wait();
        FrameSnapshot snapshot;
        ASSERT_TRUE(job.snapshot(snapshot));
        expect_same(snapshot.image, colour);
        expect_same(snapshot.whole(), colour);
        EXPECT_EQ(job.progress().rays, wanted.rays);
        expect_same(job.take_image(), colour);
    }
}

TEST(RenderJob, ACoarseImageOfColourAloneFillsTheFrame) {
    const auto accel = shared_accel(mixed_scene());
    RenderPlan plan = coarse_by(8);
    plan.channels = Channels::colour;
    const FrameSnapshot frame = coarse_frame(accel, plan);
    const Image whole = frame.whole();
    const Image wanted = render(accel, mixed_camera(), kOdd, {}).image;
    ASSERT_EQ(whole.colour.size(), kOdd.pixel_count());
    EXPECT_TRUE(whole.depth.empty() && whole.normal.empty());
    EXPECT_TRUE(whole.object.empty() && whole.primitive.empty());
    for (int row = 0; row < kOdd.rows; ++row) {
        for (int col = 0; col < kOdd.cols; ++col) {
            const std::size_t from = kOdd.index(frame.sampled_pixel({row, col}));
            ASSERT_EQ(whole.colour[kOdd.index({row, col})], wanted.colour[from]);
        }
    }
}

// Stopped at the coarse image, what is shown is the final image's pixels, each over its block.
TEST(RenderJob, TheCoarseImageIsMadeOfTheFinalOnesPixels) {
    const auto accel = shared_accel(mixed_scene());
    const Image wanted = render(accel, mixed_camera(), kOdd, {}).image;
    for (const int step : {1, 3, 8, 200}) {
        SCOPED_TRACE(step);
        const FrameSnapshot frame = coarse_frame(accel, coarse_by(step));
        EXPECT_EQ(frame.image.size, (ImageSize{(97 + step - 1) / step, (131 + step - 1) / step}));
        const Image whole = frame.whole();
        ASSERT_EQ(whole.size, kOdd);
        for (int row = 0; row < kOdd.rows; ++row) {
            for (int col = 0; col < kOdd.cols; ++col) {
                const std::size_t from = kOdd.index(frame.sampled_pixel({row, col}));
                const std::size_t at = kOdd.index({row, col});
                ASSERT_EQ(whole.colour[at], wanted.colour[from]) << row << ' ' << col;
                ASSERT_EQ(whole.object[at], wanted.object[from]) << row << ' ' << col;
            }
        }
    }
}

// What a snapshot shows at a pixel is the sample of sampled_pixel, at any moment.
TEST(RenderJob, SampledPixelIsWhoseSampleIsShown) {
    const ImageSize size{203, 301};
    const auto accel = shared_accel(mixed_scene());
    const Camera camera = mixed_camera();
    RenderSettings settings;
    settings.threads = 1;
    RenderJob job(accel, camera, size, settings);
    Random random(1);
    FrameSnapshot frame;
    int coarse = 0;
    while (!job.progress().finished) {
        if (!job.snapshot(frame)) continue;
        const Image image = frame.whole();
        for (int i = 0; i < 20; ++i) {
            const Pixel pixel{static_cast<int>(random.below(203)),
                              static_cast<int>(random.below(301))};
            const Pixel shown = frame.sampled_pixel(pixel);
            ASSERT_TRUE(size.contains(shown));
            EXPECT_EQ(shown.row / frame.step, pixel.row / frame.step);
            EXPECT_EQ(shown.col / frame.step, pixel.col / frame.step);
            if (shown != pixel) ++coarse;
            const std::optional<Hit> pick = accel->intersect(camera_ray(camera, size, shown));
            EXPECT_EQ(image.object[size.index(pixel)], pick ? pick->object : kNoObject)
                << pixel.row << ' ' << pixel.col;
        }
    }
    job.wait();
    job.snapshot(frame);
    EXPECT_GT(coarse, 0);
    for (int i = 0; i < 100; ++i) {
        const Pixel pixel{static_cast<int>(random.below(203)), static_cast<int>(random.below(301))};
        EXPECT_EQ(frame.sampled_pixel(pixel), pixel);
    }
}

TEST(RenderJob, CancelStopsInMidFrame) {
    RenderSettings settings;
    settings.depth = 100;
    RenderJob job(shared_accel(endless_scene()), Camera{}, {1500, 1500}, settings);
    std::this_thread::sleep_for(milliseconds(100));
    const auto asked = Clock::now();
    job.cancel();
    EXPECT_LT(Clock::now() - asked, milliseconds(10)) << "cancel itself must not wait";
    job.wait();
    // 20 ms are promised; a busy or sanitised machine gets more.
    EXPECT_LT(Clock::now() - asked, milliseconds(400));
    EXPECT_TRUE(job.progress().finished);
    EXPECT_TRUE(job.progress().cancelled);
    EXPECT_LT(job.progress().fraction, 1.0);
    RecordProperty(
        "milliseconds",
        static_cast<int>(std::chrono::duration_cast<milliseconds>(Clock::now() - asked).count()));
    job.cancel();  // again does no harm
    job.wait();
}

// Rays split at both sheets of glass, again and again, 40 deep: nothing but a look at the stop
// token between rays ends a pixel of it.
TEST(RenderJob, CancelStopsWithinAPixel) {
    Scene scene;
    Material glass;
    glass.reflect = glm::vec3(0.5f);
    glass.transmit = glm::vec3(0.5f);
    glass.thin_walled = true;  // without insides, which would decide whether a ray splits
    place(scene, Sphere{{0.0, 0.0, 0.0}, 3.0}, add_material(scene, glass));
    place(scene, Sphere{{0.0, 0.0, 0.0}, 50.0}, 0);
    RenderSettings settings;
    settings.depth = 40;
    settings.cutoff = 0.0f;  // else each path ends once it adds too little
    Camera camera;
    camera.eye = {0.0, 0.0, 2.0};
    RenderJob job(shared_accel(std::move(scene)), camera, {4, 4}, settings);
    std::this_thread::sleep_for(milliseconds(50));
    ASSERT_FALSE(job.progress().finished);
    const auto asked = Clock::now();
    job.cancel();
    job.wait();
    EXPECT_LT(Clock::now() - asked, milliseconds(400));
    EXPECT_TRUE(job.progress().cancelled);
    EXPECT_EQ(job.progress().version, 0u) << "nothing half traced is shown";
}

TEST(RenderJob, DestructorWhileRunning) {
    RenderSettings settings;
    settings.depth = 100;
    for (int i = 0; i < 5; ++i) {
        auto job = std::make_unique<RenderJob>(shared_accel(endless_scene()), Camera{},
                                               ImageSize{600, 600}, settings);
        std::this_thread::sleep_for(milliseconds(3 * i));
        const auto asked = Clock::now();
        job.reset();
        EXPECT_LT(Clock::now() - asked, milliseconds(400));
    }
}

TEST(RenderJob, KeepsItsSceneAlive) {
    auto accel = shared_accel(mixed_scene());
    const std::weak_ptr<const Accel> watch = accel;
    const Image wanted = render(accel, mixed_camera(), {64, 64}, {}).image;
    {
        RenderJob job(std::move(accel), mixed_camera(), {64, 64}, {});
        job.wait();
        EXPECT_FALSE(watch.expired());
        FrameSnapshot frame;
        job.snapshot(frame);
        expect_same(frame.image, wanted);
    }
    EXPECT_TRUE(watch.expired()) << "the job let go of it";
}

TEST(RenderJob, SeveralAtOnce) {
    const auto accel = shared_accel(mixed_scene());
    const Image wanted = render(accel, mixed_camera(), {64, 96}, {}).image;
    std::vector<std::unique_ptr<RenderJob>> jobs;
    jobs.reserve(4);
    for (int i = 0; i < 4; ++i) {
        jobs.push_back(std::make_unique<RenderJob>(accel, mixed_camera(), ImageSize{64, 96},
                                                   RenderSettings{}));
    }
    for (const auto& job : jobs) {
        job->wait();
        FrameSnapshot frame;
        job->snapshot(frame);
        expect_same(frame.image, wanted);
    }
}

TEST(RenderJob, DepthOneHasNoSecondaryRays) {
    RenderSettings settings;
    settings.depth = 1;
    const RenderedFrame frame =
        render(shared_accel(mixed_scene()), mixed_camera(), {40, 40}, settings);
    EXPECT_EQ(frame.rays.reflection, 0u);
    EXPECT_EQ(frame.rays.refraction, 0u);
    EXPECT_GT(frame.rays.shadow, 0u);
    EXPECT_GT(frame.seconds, 0.0);
}

}  // namespace
}  // namespace raypick
