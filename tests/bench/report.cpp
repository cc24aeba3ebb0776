#include "tests/bench/report.h"

#include "tests/bench/machine.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

namespace raypick::bench {

namespace {

// Three figures that count.
std::string rounded(double value) {
    const double size = std::abs(value);
    return fmt::format("{:.{}f}", value, size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
}

std::string target_text(const Target& target) {
    const char* sign = target.low_is_good ? "<=" : ">=";
    return fmt::format("floor {} {}, aim {} {}", sign, target.floor, sign, target.aim);
}

nlohmann::json to_json(const Summary& summary) {
    return {{"median", summary.median}, {"min", summary.least}, {"max", summary.most}};
}

nlohmann::json to_json(const Row& row) {
    nlohmann::json json{{"name", row.name}, {"threads", row.threads}};
    for (const Figure& figure : row.figures) {
        nlohmann::json entry = to_json(figure.value);
        entry["unit"] = figure.unit;
        json["figures"][figure.name] = std::move(entry);
    }
    if (row.result) {
        json["result"] = to_json(*row.result);
        json["result"]["name"] = row.result_name;
        json["result"]["unit"] = row.result_unit;
    }
    if (row.target) {
        json["floor"] = row.target->floor;
        json["aim"] = row.target->aim;
        json["verdict"] = verdict(row);
    }
    return json;
}

bool in_ci() {
    const char* ci = std::getenv("CI");
    return ci != nullptr && std::string(ci) == "true";
}

}  // namespace

std::vector<Figure> in_milliseconds(const std::vector<Timing>& timings) {
    std::vector<Figure> figures;
    for (const Timing& timing : timings) {
        std::vector<double> times;
        for (const double seconds : timing.seconds)
            times.push_back(1000.0 * seconds);
        figures.push_back({timing.name, summary(times), "ms"});
    }
    return figures;
}

std::string verdict(const Row& row) {
    if (!row.target || !row.result) return "";
    const double sign = row.target->low_is_good ? -1.0 : 1.0;
    const double value = sign * row.result->median;
    if (value >= sign * row.target->aim) return "aim";
    return value >= sign * row.target->floor ? "floor" : "below floor";
}

Report::Report(const Options& options) : options_(options), machine_(describe_machine()) {
    for (const std::string& line : machine_)
        std::cout << line << '\n';
    std::cout << fmt::format("{} round{}, medians (least to most)\n", options.rounds,
                             options.rounds == 1 ? "" : "s");
}

bool Report::wants(const std::string& name) const {
    return name.find(options_.only) != std::string::npos;
}

bool Report::wants_any(const std::vector<std::string>& names) const {
    return std::any_of(names.begin(), names.end(),
                       [this](const std::string& name) { return wants(name); });
}

void Report::add(Row row) {
    // So little work says nothing about speed.
    if (options_.smoke) row.target.reset();
    std::cout << '\n' << row.name;
    if (row.threads > 0)
        std::cout << fmt::format(", {} thread{}", row.threads, row.threads == 1 ? "" : "s");
    std::cout << '\n';
    for (const Figure& figure : row.figures) {
        std::cout << fmt::format("    {:<24} {:>9} {:<8} ({} to {})\n", figure.name,
                                 rounded(figure.value.median), figure.unit,
                                 rounded(figure.value.least), rounded(figure.value.most));
    }
    if (row.result) {
        std::cout << fmt::format("  {:<26} {:>9} {:<8} ({} to {})", row.result_name,
                                 rounded(row.result->median), row.result_unit,
                                 rounded(row.result->least), rounded(row.result->most));
        if (row.target) std::cout << "  " << target_text(*row.target) << ": " << verdict(row);
        std::cout << '\n';
    }
    std::cout.flush();
    rows_.push_back(std::move(row));
}

void Report::note(const std::string& text) {
    notes_.push_back(text);
    std::cout << "    " << text << std::endl;
}

void Report::missing(const std::string& what) {
    if (std::find(missing_.begin(), missing_.end(), what) != missing_.end()) return;
    missing_.push_back(what);
    std::cout << "missing: " << what << std::endl;
}

void Report::wrong(const std::string& what) {
    wrong_.push_back(what);
    std::cout << "WRONG: " << what << std::endl;
}

int Report::finish() const {
    std::map<std::string, int> verdicts;
    for (const Row& row : rows_) {
        if (const std::string word = verdict(row); !word.empty()) ++verdicts[word];
    }
    std::cout << fmt::format("\n{} rows: {} reach the aim, {} hold the floor, {} below the floor\n",
                             rows_.size(), verdicts["aim"], verdicts["floor"],
                             verdicts["below floor"]);
    for (const std::string& what : missing_)
        std::cout << "missing: " << what << '\n';
    for (const std::string& what : wrong_)
        std::cout << "WRONG: " << what << '\n';
    if (!options_.json.empty()) write_json();
    return !wrong_.empty() || (in_ci() && !missing_.empty()) ? 1 : 0;
}

void Report::write_json() const {
    nlohmann::json json{{"machine", machine_},
                        {"rounds", options_.rounds},
                        {"notes", notes_},
                        {"missing", missing_},
                        {"wrong", wrong_}};
    json["smoke"] = options_.smoke;
    json["isa"] = options_.isa;
    json["rows"] = nlohmann::json::array();
    for (const Row& row : rows_)
        json["rows"].push_back(to_json(row));
    std::ofstream(options_.json) << json.dump(2) << '\n';
}

}  // namespace raypick::bench
