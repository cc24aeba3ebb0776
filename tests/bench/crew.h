// Plain threads that share out numbered pieces of work: the same for every peer, so that none is
// judged by another's scheduler.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace raypick::bench {

// Calls work(worker, piece) for every piece below `pieces`, worker being 0 to threads - 1.
template <class Work>
void share_out(std::size_t pieces, int threads, const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto run = [&](std::size_t worker) {
        for (std::size_t piece = next++; piece < pieces; piece = next++)
            work(worker, piece);
    };
    std::vector<std::jthread> crew;
    for (int i = 1; i < threads; ++i)
        crew.emplace_back(run, static_cast<std::size_t>(i));
    run(0);
}

}  // namespace raypick::bench
