#include "tracer/accel/background_build.h"

#include "tracer/error.h"
#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

namespace raypick {

namespace {

using Clock = std::chrono::steady_clock;

std::shared_ptr<const Accel> build_accel(std::shared_ptr<const Scene> scene,
                                         const BuildOptions& options) {
    return std::make_shared<const Accel>(std::move(scene), options);
}

// The first trees are waited for; while the better ones are made people go on working.
int threads_for(TreeQuality quality) {
    return quality == TreeQuality::first ? 0 : std::max(1, hardware_threads() - 1);
}

}  // namespace

struct BackgroundBuild::State {
    std::shared_ptr<const Scene> scene;
    std::function<void()> notify;
    Build build;

    mutable std::mutex mutex;
    BuildProgress progress;  // guarded by it

    std::jthread thread;  // last: joined before anything else goes

    void run(const std::stop_token& stop);
    void build_both(const std::stop_token& stop);
    void build_one(TreeQuality quality, const std::stop_token& stop);
    template <typename Change>
    void change(const Change& how);
};

template <typename Change>
void BackgroundBuild::State::change(const Change& how) {
    {
        const std::lock_guard lock(mutex);
        how(progress);
    }
    if (notify) notify();
}

void BackgroundBuild::State::run(const std::stop_token& stop) {
    std::string error;
    try {
        build_both(stop);
    } catch (const Cancelled&) {
        // Nobody waits for it any more.
    } catch (const std::bad_alloc&) {
        error = "not enough memory";
    } catch (const std::exception& failure) {
        error = failure.what();
    }
    change([&error](BuildProgress& now) {
        now.error = std::move(error);
        now.finished = true;
    });
}

void BackgroundBuild::State::build_both(const std::stop_token& stop) {
    if (!progress.accel) build_one(TreeQuality::first, stop);
    build_one(TreeQuality::many_rays, stop);
}

void BackgroundBuild::State::build_one(TreeQuality quality, const std::stop_token& stop) {
    if (stop.stop_requested()) throw Cancelled();
    const Clock::time_point start = Clock::now();
    std::shared_ptr<const Accel> built =
        build(scene, {.threads = threads_for(quality), .stop = stop, .quality = quality});
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    change([&](BuildProgress& now) {
        now.accel.swap(built);
        now.quality = quality;
        (quality == TreeQuality::first ? now.first_seconds : now.many_rays_seconds) = seconds;
    });
}

BackgroundBuild::BackgroundBuild(std::shared_ptr<const Scene> scene, std::function<void()> notify,
                                 std::shared_ptr<const Accel> first, Build build)
    : state_(std::make_unique<State>()) {
    state_->scene = std::move(scene);
    state_->notify = std::move(notify);
    state_->build = build ? std::move(build) : Build(build_accel);
    state_->progress.accel = std::move(first);
    state_->thread =
        std::jthread([state = state_.get()](const std::stop_token& stop) { state->run(stop); });
}

BackgroundBuild::~BackgroundBuild() {
    cancel();
}

void BackgroundBuild::cancel() {
    state_->thread.request_stop();
}

void BackgroundBuild::wait() {
    if (state_->thread.joinable()) state_->thread.join();
}

BuildProgress BackgroundBuild::progress() const {
    const std::lock_guard lock(state_->mutex);
    return state_->progress;
}

}  // namespace raypick
