// What the benchmarks found: a table on standard output, and the same as JSON.
#pragma once

#include "tests/bench/measure.h"
#include "tests/bench/options.h"

#include <optional>
#include <string>
#include <vector>

namespace raypick::bench {

// What must hold, and what we want. Ratios should be high; times and bytes low.
struct Target {
    double floor = 0.0;
    double aim = 0.0;
    bool low_is_good = false;
};

// One figure of a row with what it is of: "Embree stream", 33.5, "Mrays/s".
struct Figure {
    std::string name;
    Summary value;
    std::string unit;
};

std::vector<Figure> in_milliseconds(const std::vector<Timing>& timings);

// One line of the table on one scene.
struct Row {
    std::string name;  // group/scene/what
    int threads = 0;   // 0: that is no question here
    std::vector<Figure> figures;
    std::string result_name;  // "ours / Embree stream"
    std::optional<Summary> result;
    std::string result_unit = "x";
    std::optional<Target> target;
};

// "below floor", "floor" (it holds), "aim" (reached); "" without a target.
std::string verdict(const Row& row);

// Rows as they come, and what was wrong on the way.
class Report {
public:
    explicit Report(const Options& options);

    // True if --only names it.
    [[nodiscard]] bool wants(const std::string& name) const;
    // True if it names a row of this group (a name's first parts) or could.
    [[nodiscard]] bool wants_any(const std::vector<std::string>& names) const;

    void add(Row row);
    // A line for people, not a number: a peer's setting, a check that held.
    void note(const std::string& text);
    // Something without which rows are left out. In CI (CI=true) nothing may be missing.
    void missing(const std::string& what);
    // A check that did not hold: the run fails.
    void wrong(const std::string& what);

    [[nodiscard]] const Options& options() const { return options_; }

    // Prints how many rows are where, writes the JSON; the program's exit code.
    [[nodiscard]] int finish() const;

private:
    void write_json() const;

    const Options& options_;
    std::vector<std::string> machine_;
    std::vector<Row> rows_;
    std::vector<std::string> notes_;
    std::vector<std::string> missing_;
    std::vector<std::string> wrong_;
};

}  // namespace raypick::bench
