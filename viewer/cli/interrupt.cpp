#include "viewer/cli/interrupt.h"

#include "viewer/cli/exit_code.h"

#include <pthread.h>
#include <unistd.h>

namespace raypick {

Interrupt::Interrupt() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    // Blocked here and, by inheritance, in all threads to come: only the watcher takes them.
    pthread_sigmask(SIG_BLOCK, &signals_, &old_mask_);
    watcher_ = std::thread([this] { watch(); });
}

Interrupt::~Interrupt() {
    ending_ = true;
    pthread_kill(watcher_.native_handle(), SIGINT);  // wakes the watcher
    watcher_.join();
    pthread_sigmask(SIG_SETMASK, &old_mask_, nullptr);
}

void Interrupt::check() const {
    if (signal_ != 0) throw Interrupted(signal_);
}

void Interrupt::watch() {
    int signal = 0;
    while (sigwait(&signals_, &signal) == 0 && !ending_) {
        if (signal_ != 0) _exit(kExitSignalBase + signal);  // asked twice: no more manners
        signal_ = signal;
        stop_.request_stop();
    }
}

}  // namespace raypick
