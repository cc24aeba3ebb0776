#include "tests/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <iostream>
#include <limits>

namespace raypick::bench {

namespace {

// The place in the list of who comes `turn`-th in a round.
std::size_t place(std::size_t turn, int round, std::size_t count) {
    return round % 2 == 0 ? turn : count - 1 - turn;
}

}  // namespace

std::vector<Timing> alternate(const std::vector<Contender>& contenders, int rounds) {
    std::vector<Timing> timings;
    timings.reserve(contenders.size());
    for (const Contender& contender : contenders)
        timings.push_back({contender.name, {}});
    std::vector<bool> failed(contenders.size(), false);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t turn = 0; turn < contenders.size(); ++turn) {
            const std::size_t i = place(turn, round, contenders.size());
            if (failed[i]) continue;
            try {
                timings[i].seconds.push_back(contenders[i].run());
            } catch (const std::exception& error) {
                std::cerr << contenders[i].name << ": " << error.what() << '\n';
                failed[i] = true;
            }
        }
    }
    std::vector<Timing> complete;
    for (std::size_t i = 0; i < timings.size(); ++i) {
        if (!failed[i]) complete.push_back(std::move(timings[i]));
    }
    return complete;
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    const auto last = static_cast<double>(values.size() - 1);
    return values[static_cast<std::size_t>(std::lround(share * last))];
}

Summary summary(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0.0), quantile(values, 1.0)};
}

Summary ratio(const Timing& theirs, const Timing& ours) {
    std::vector<double> ratios;
    const std::size_t rounds = std::min(theirs.seconds.size(), ours.seconds.size());
    for (std::size_t i = 0; i < rounds; ++i)
        ratios.push_back(theirs.seconds[i] / ours.seconds[i]);
    return summary(ratios);
}

std::optional<Timing> fastest(const std::vector<Timing>& timings) {
    const Timing* best = nullptr;
    for (const Timing& timing : timings) {
        if (best == nullptr || summary(timing.seconds).median < summary(best->seconds).median) {
            best = &timing;
        }
    }
    return best == nullptr ? std::nullopt : std::optional<Timing>(*best);
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace raypick::bench
