// Times contenders against each other: one after the other in every round, so that a change of the
// machine's speed meets all of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace raypick::bench {

// Does its work once and says how many seconds of it count.
struct Contender {
    std::string name;
    std::function<double()> run;
};

struct Timing {
    std::string name;
    std::vector<double> seconds;  // by round
};

// Every contender once in each round, in turn; every second round runs backwards. A contender that
// throws is left out from there on, and standard error says why. The caller has warmed up.
std::vector<Timing> alternate(const std::vector<Contender>& contenders, int rounds);

struct Summary {
    double median = 0.0;
    double least = 0.0;
    double most = 0.0;
};

Summary summary(const std::vector<double>& values);
// The value that a share of 0..1 of the values doesn't exceed.
double quantile(std::vector<double> values, double share);

// By round: how many times as long `theirs` took as `ours`.
Summary ratio(const Timing& theirs, const Timing& ours);

// The least median; nothing if there are none.
std::optional<Timing> fastest(const std::vector<Timing>& timings);

// Seconds that a call takes.
double seconds_of(const std::function<void()>& work);

}  // namespace raypick::bench
