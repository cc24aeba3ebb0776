// Results of a parallel loop, taken in the order of its indices.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace raypick {

// Calls take(i) for each i of [0, count) once it is ready, in order, one at a time, on whichever
// thread makes that possible: none waits for another.
class InOrder {
public:
    InOrder(std::size_t count, std::function<void(std::size_t)> take)
        : take_(std::move(take)), ready_(count, false) {}

    // Each index once. Throws what take throws; nothing more is taken then.
    void ready(std::size_t i);

private:
    std::function<void(std::size_t)> take_;
    std::mutex mutex_;
    std::vector<bool> ready_;
    std::size_t next_ = 0;  // to be taken
    bool taking_ = false;
};

}  // namespace raypick
