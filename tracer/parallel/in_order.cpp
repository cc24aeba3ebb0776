#include "tracer/parallel/in_order.h"

namespace raypick {

void InOrder::ready(std::size_t i) {
    std::unique_lock lock(mutex_);
    ready_[i] = true;
    if (taking_) return;
    taking_ = true;
    while (next_ < ready_.size() && ready_[next_]) {
        lock.unlock();
        take_(next_);
        lock.lock();
        ++next_;
    }
    taking_ = false;
}

}  // namespace raypick
