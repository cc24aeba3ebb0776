#include "tracer/parallel/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#ifdef RAYPICK_THREADS_TBB
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#endif

namespace raypick {

namespace {

// Hands out indices to however many threads come, in order; keeps the first exception.
class SharedLoop {
public:
    SharedLoop(std::size_t count, const std::stop_token& stop,
               const std::function<void(std::size_t)>& body)
        : count_(count), stop_(stop), body_(body) {}

    void work() {
        while (!stop_.stop_requested() && !failed_.load(std::memory_order_relaxed)) {
            const std::size_t i = next_.fetch_add(1, std::memory_order_relaxed);
            if (i >= count_) return;
            try {
                body_(i);
            } catch (...) {
                keep(std::current_exception());
            }
        }
    }

    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    void keep(std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(failure);
        failed_.store(true, std::memory_order_relaxed);
    }

    std::size_t count_;
    const std::stop_token& stop_;
    const std::function<void(std::size_t)>& body_;
    std::atomic<std::size_t> next_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_;
    std::exception_ptr failure_;
};

#ifdef RAYPICK_THREADS_TBB
// Runs `tasks` times the same on up to as many of `threads` threads.
void run_in_arena(std::size_t tasks, int threads, const std::function<void()>& work) {
    const auto run = [&] {
        tbb::parallel_for(
            std::size_t{0}, tasks, [&](std::size_t) { work(); }, tbb::simple_partitioner());
    };
    // In the arena that the calling thread is in already, if it is of that size: workers stay there
    // from one loop to the next. Where they look for work a while after a loop, and where other
    // programs keep the cores busy, they did not come to that of the next loop before it was over.
    if (threads == tbb::this_task_arena::max_concurrency()) {
        tbb::this_task_arena::isolate(run);  // the waiting thread begins nothing else
    } else {
        tbb::task_arena(threads).execute(run);
    }
}
#endif

}  // namespace

int hardware_threads() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void count_cores() {
#ifdef RAYPICK_THREADS_TBB
    static_cast<void>(tbb::info::default_concurrency());  // oneTBB keeps what it found
#endif
}

void parallel_for(std::size_t count, int threads, const std::stop_token& stop,
                  const std::function<void(std::size_t)>& body) {
    const auto wanted = static_cast<std::size_t>(threads > 0 ? threads : hardware_threads());
    const std::size_t workers = std::min(wanted, count);
    SharedLoop loop(count, stop, body);
    if (workers <= 1) {
        loop.work();
    } else {
#ifdef RAYPICK_THREADS_TBB
        // TBB has no more workers than cores, and says so on standard error if asked for more.
        const std::size_t most = std::min(wanted, static_cast<std::size_t>(hardware_threads()));
        run_in_arena(std::min(most, count), static_cast<int>(most), [&] { loop.work(); });
#else
        std::vector<std::jthread> team;
        for (std::size_t i = 1; i < workers; ++i)
            team.emplace_back([&] { loop.work(); });
        loop.work();
#endif
    }
    loop.rethrow();
}

}  // namespace raypick
