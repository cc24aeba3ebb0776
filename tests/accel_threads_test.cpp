// Building and asking with several threads; runs under ThreadSanitizer too.
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <thread>

namespace raypick {
namespace {

std::shared_ptr<const Scene> soup_scene(std::uint32_t triangles) {
    Scene scene;
    place_mesh(scene, soup_data(1, triangles, 0.1));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.5, 0.0, 0.0}));
    place(scene, Sphere{});
    return std::make_shared<const Scene>(std::move(scene));
}

TEST(AccelThreads, TheTreeIsTheSameForAnyNumber) {
    const auto scene = soup_scene(20000);
    const Accel one(scene, {.threads = 1, .stop = {}});
    for (const int threads : {2, 3, 0}) {
        const Accel many(scene, {.threads = threads, .stop = {}});
        EXPECT_EQ(many.stats().nodes, one.stats().nodes);
        EXPECT_EQ(many.stats().bytes, one.stats().bytes);
        for (const Ray& ray : rays_through(one.bounds(), 2, 2000)) {
            ASSERT_EQ(many.intersect(ray), one.intersect(ray));
        }
    }
}

TEST(AccelThreads, ManyThreadsMayAskAtOnce) {
    const Accel accel(soup_scene(3000));
    const std::vector<Ray> rays = rays_through(accel.bounds(), 3, 1000);
    std::vector<Hit> wanted(rays.size());
    accel.intersect(rays, wanted);
    std::atomic<int> wrong{0};
    {
        std::vector<std::jthread> threads;
        threads.reserve(8);
        for (int i = 0; i < 8; ++i) {
            threads.emplace_back([&, i] {
                std::vector<Hit> hits(rays.size());
                accel.intersect(rays, hits);
                if (hits != wanted) ++wrong;
                for (auto r = static_cast<std::size_t>(i); r < rays.size(); r += 8) {
                    if (accel.intersect(rays[r]).value_or(Hit{}) != wanted[r]) ++wrong;
                    if (accel.occluded(rays[r]) != wanted[r].valid()) ++wrong;
                    if (accel.intersect_all(rays[r]).empty() == wanted[r].valid()) ++wrong;
                }
            });
        }
    }
    EXPECT_EQ(wrong, 0);
}

TEST(AccelThreads, AStoppedBuildIsCancelled) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(Accel(soup_scene(2000), {.threads = 0, .stop = stop.get_token()}), Cancelled);
}

TEST(AccelThreads, ABuildStopsOnTheWay) {
    using Clock = std::chrono::steady_clock;
    const auto scene = soup_scene(400000);
    std::stop_source stop;
    Clock::time_point asked;
    std::jthread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        asked = Clock::now();
        stop.request_stop();
    });
    EXPECT_THROW(Accel(scene, {.threads = 1, .stop = stop.get_token()}), Cancelled);
    const Clock::time_point thrown = Clock::now();
    later.join();
    EXPECT_LT(thrown - asked, std::chrono::milliseconds(500));
}

TEST(ParallelFor, VisitsEachIndexOnce) {
    for (const int threads : {0, 1, 2, 7}) {
        for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
            std::vector<std::atomic<int>> visits(count);
            parallel_for(count, threads, {}, [&](std::size_t i) { ++visits[i]; });
            for (const std::atomic<int>& v : visits)
                EXPECT_EQ(v, 1);
        }
    }
}

TEST(ParallelFor, UsesNoMoreThreadsThanAsked) {
    for (const int threads : {1, 2, 3}) {
        std::atomic<int> now{0};
        std::atomic<int> most{0};
        parallel_for(50, threads, {}, [&](std::size_t) {
            const int running = ++now;
            int seen = most;
            while (running > seen && !most.compare_exchange_weak(seen, running)) {
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            --now;
        });
        EXPECT_LE(most, threads);
        EXPECT_GE(most, 1);
    }
    EXPECT_GE(hardware_threads(), 1);
}

TEST(ParallelFor, BeginsNothingOnceStopped) {
    std::stop_source stop;
    std::atomic<int> begun{0};
    parallel_for(100000, 2, stop.get_token(), [&](std::size_t) {
        if (++begun == 10) stop.request_stop();
    });
    EXPECT_GE(begun, 10);
    EXPECT_LT(begun, 100);
}

TEST(ParallelFor, CarriesTheFirstExceptionOut) {
    for (const int threads : {1, 2}) {
        std::atomic<int> begun{0};
        try {
            parallel_for(1000000, threads, {}, [&](std::size_t i) {
                ++begun;
                if (i % 1000 == 7) throw std::out_of_range("seven");
            });
            FAIL() << "it must throw";
        } catch (const std::out_of_range& error) {
            EXPECT_STREQ(error.what(), "seven");
        }
        EXPECT_LT(begun, 1000000);
    }
}

TEST(ParallelFor, Nests) {
    std::atomic<int> visits{0};
    parallel_for(8, 2, {},
                 [&](std::size_t) { parallel_for(8, 2, {}, [&](std::size_t) { ++visits; }); });
    EXPECT_EQ(visits, 64);
}

}  // namespace
}  // namespace raypick
