// Trees built beside everything else; runs under ThreadSanitizer too. What is built, and when, is
// the test's to say: no clock decides.
#include "tracer/accel/background_build.h"

#include "tests/tracer_scenes.h"
#include "tracer/error.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace raypick {
namespace {

using AccelPointer = std::shared_ptr<const Accel>;
using ScenePointer = std::shared_ptr<const Scene>;

ScenePointer soup_scene() {
    Scene scene;
    place_mesh(scene, soup_data(1, 20000, 0.1));
    place(scene, Sphere{});
    return std::make_shared<const Scene>(std::move(scene));
}

// A point that one thread waits at until another opens it.
class Gate {
public:
    void open() {
        {
            const std::lock_guard lock(mutex_);
            open_ = true;
        }
        opened_.notify_all();
    }
    void pass() {
        std::unique_lock lock(mutex_);
        opened_.wait(lock, [this] { return open_; });
    }

private:
    std::mutex mutex_;
    std::condition_variable opened_;
    bool open_ = false;
};

// Counts changes, so that a test can wait for the next one.
class Bell {
public:
    void ring() {
        {
            const std::lock_guard lock(mutex_);
            ++rung_;
        }
        heard_.notify_all();
    }
    void wait_for(int count) {
        std::unique_lock lock(mutex_);
        heard_.wait(lock, [&] { return rung_ >= count; });
    }
    int count() {
        const std::lock_guard lock(mutex_);
        return rung_;
    }

private:
    std::mutex mutex_;
    std::condition_variable heard_;
    int rung_ = 0;
};

AccelPointer build_really(ScenePointer scene, const BuildOptions& options) {
    return std::make_shared<const Accel>(std::move(scene), options);
}

TEST(BackgroundBuild, TheFirstTreeIsUsableWhileTheBetterOneIsBuilt) {
    const ScenePointer scene = soup_scene();
    Gate better;
    Bell bell;
    BackgroundBuild build(
        scene, [&] { bell.ring(); }, nullptr,
        [&](ScenePointer what, const BuildOptions& options) {
            if (options.quality == TreeQuality::many_rays) better.pass();
            return build_really(std::move(what), options);
        });
    bell.wait_for(1);
    const BuildProgress first = build.progress();
    ASSERT_NE(first.accel, nullptr);
    EXPECT_EQ(first.quality, TreeQuality::first);
    EXPECT_FALSE(first.finished);
    EXPECT_EQ(first.accel->shared_scene(), scene);
    const std::vector<Ray> rays = rays_through(first.accel->bounds(), 2, 2000);
    std::vector<Hit> hits(rays.size());
    first.accel->intersect(rays, hits);

    better.open();
    build.wait();
    const BuildProgress last = build.progress();
    ASSERT_TRUE(last.finished);
    EXPECT_EQ(last.error, "");
    EXPECT_EQ(last.quality, TreeQuality::many_rays);
    EXPECT_EQ(last.first_seconds, first.first_seconds);
    EXPECT_GT(last.many_rays_seconds, 0.0);
    ASSERT_NE(last.accel, first.accel);
    std::vector<Hit> again(rays.size());
    last.accel->intersect(rays, again);
    EXPECT_EQ(hits, again) << "another tree, the same hits";
    first.accel->intersect(rays, again);
    EXPECT_EQ(hits, again) << "who holds the first one goes on with it";
    EXPECT_EQ(bell.count(), 3) << "a tree, a tree, the end";
}

TEST(BackgroundBuild, BothTreesAreThoseOfAccel) {
    const ScenePointer scene = soup_scene();
    std::vector<TreeQuality> built;
    BackgroundBuild build(scene, {}, nullptr, [&](ScenePointer what, const BuildOptions& options) {
        built.push_back(options.quality);
        return build_really(std::move(what), options);
    });
    build.wait();
    EXPECT_EQ(built, (std::vector{TreeQuality::first, TreeQuality::many_rays}));
    BackgroundBuild plain(scene, {});
    plain.wait();
    EXPECT_EQ(plain.progress().accel->stats().nodes, Accel(scene).stats().nodes);
}

TEST(BackgroundBuild, GoesOnFromAFirstTree) {
    const ScenePointer scene = soup_scene();
    const AccelPointer first = build_really(scene, {.quality = TreeQuality::first});
    std::vector<TreeQuality> built;
    BackgroundBuild build(scene, {}, first, [&](ScenePointer what, const BuildOptions& options) {
        built.push_back(options.quality);
        return build_really(std::move(what), options);
    });
    build.wait();
    EXPECT_EQ(built, std::vector{TreeQuality::many_rays});
    EXPECT_EQ(build.progress().quality, TreeQuality::many_rays);
    EXPECT_EQ(build.progress().first_seconds, 0.0);
}

TEST(BackgroundBuild, WithoutMemoryForTheBetterTreeTheFirstOneStays) {
    BackgroundBuild build(soup_scene(), {}, nullptr,
                          [](ScenePointer what, const BuildOptions& options) {
                              if (options.quality == TreeQuality::many_rays) throw std::bad_alloc();
                              return build_really(std::move(what), options);
                          });
    build.wait();
    const BuildProgress last = build.progress();
    EXPECT_TRUE(last.finished);
    EXPECT_EQ(last.error, "not enough memory");
    ASSERT_NE(last.accel, nullptr);
    EXPECT_EQ(last.quality, TreeQuality::first);
    EXPECT_GT(last.accel->stats().nodes, 0u);
}

TEST(BackgroundBuild, ASceneThatCannotBeBuiltIsAMessage) {
    Scene scene;
    place(scene, MeshInstance{7});
    BackgroundBuild build(std::make_shared<const Scene>(std::move(scene)), {});
    build.wait();
    EXPECT_TRUE(build.progress().finished);
    EXPECT_EQ(build.progress().accel, nullptr);
    EXPECT_NE(build.progress().error, "");
}

TEST(BackgroundBuild, CancelledOnTheWayItKeepsWhatThereIs) {
    Bell bell;
    BackgroundBuild build(
        soup_scene(), [&] { bell.ring(); }, nullptr,
        [](ScenePointer what, const BuildOptions& options) {
            // The better one takes until it is stopped.
            while (options.quality == TreeQuality::many_rays) {
                if (options.stop.stop_requested()) throw Cancelled();
                std::this_thread::yield();
            }
            return build_really(std::move(what), options);
        });
    bell.wait_for(1);
    build.cancel();
    build.wait();
    const BuildProgress last = build.progress();
    EXPECT_TRUE(last.finished);
    EXPECT_EQ(last.error, "");
    EXPECT_NE(last.accel, nullptr);
    EXPECT_EQ(last.quality, TreeQuality::first);
}

TEST(BackgroundBuild, OnceCancelledNothingMoreIsBegun) {
    Gate go;
    std::atomic<int> begun = 0;
    BackgroundBuild build(soup_scene(), {}, nullptr,
                          [&](ScenePointer what, const BuildOptions& options) {
                              ++begun;
                              go.pass();
                              BuildOptions deaf = options;
                              deaf.stop = {};  // it ends although it was asked to stop
                              return build_really(std::move(what), deaf);
                          });
    while (begun == 0)
        std::this_thread::yield();
    build.cancel();
    go.open();
    build.wait();
    EXPECT_EQ(begun, 1);
    EXPECT_TRUE(build.progress().finished);
}

TEST(BackgroundBuild, TheDestructorStopsIt) {
    const ScenePointer scene = soup_scene();
    for (int i = 0; i < 5; ++i)
        const BackgroundBuild build(scene, {});
    Gate begun;
    {
        const BackgroundBuild build(scene, {}, nullptr,
                                    [&](const ScenePointer&, const BuildOptions& options) {
                                        begun.open();
                                        while (!options.stop.stop_requested())
                                            std::this_thread::yield();
                                        throw Cancelled();
                                        return AccelPointer();
                                    });
        begun.pass();
    }
    EXPECT_EQ(scene.use_count(), 1) << "and lets go of the scene";
}

TEST(BackgroundBuild, QueriesRunOnWhileTreesAreExchanged) {
    BackgroundBuild build(soup_scene(), {});
    const Ray ray{{0.1f, 0.2f, -5.0f}, {0.0f, 0.0f, 1.0f}};
    std::optional<Hit> wanted;
    int asked = 0;
    bool wrong = false;
    for (bool finished = false; !finished;) {
        const BuildProgress now = build.progress();
        finished = now.finished;
        if (!now.accel) continue;
        const std::optional<Hit> hit = now.accel->intersect(ray);
        if (asked++ == 0) wanted = hit;
        wrong = wrong || hit != wanted;
    }
    EXPECT_GT(asked, 0);
    EXPECT_FALSE(wrong);
}

}  // namespace
}  // namespace raypick
