// Parallel loops: oneTBB, or plain std::jthread where ThreadSanitizer must see through
// (RAYPICK_THREADS=std).
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

namespace raypick {

// Calls body(i) for every i in [0, count), in no particular order, on up to `threads` threads (0:
// all cores), and returns when all are done. Once `stop` is requested no further index is begun.
// The first exception thrown by a body stops the loop and is rethrown here.
void parallel_for(std::size_t count, int threads, const std::stop_token& stop,
                  const std::function<void(std::size_t)>& body);

// Number of threads that 0 stands for.
int hardware_threads();

// Counts the cores now, for all loops to come. To be called before another thread begins with
// loops while this one starts OpenGL: Mesa moves the thread that starts it from core to core, to
// learn which ones share a cache, and oneTBB, which asks where the first thread may run, would take
// one core for all that there are.
void count_cores();

}  // namespace raypick
