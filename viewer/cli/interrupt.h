// Ctrl+C and friends as a stop_token.
#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace raypick {

// While it lives, SIGINT and SIGTERM ask the work to stop instead of killing the program; a second
// one kills it. Make it before any thread that should not be hit by these signals.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    // Stop is requested when a signal arrives.
    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
    // Throws Interrupted if a signal arrived.
    void check() const;

private:
    void watch();

    sigset_t signals_{};
    sigset_t old_mask_{};
    std::atomic<int> signal_{0};
    std::atomic<bool> ending_{false};
    std::stop_source stop_;
    std::thread watcher_;
};

}  // namespace raypick
