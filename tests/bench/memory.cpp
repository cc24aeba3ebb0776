#include "tests/bench/command.h"
#include "tests/bench/embree_scene.h"
#include "tests/bench/groups.h"
#include "tests/bench/scenes.h"
#include "tracer/accel/accel.h"

#include <fmt/format.h>
#include <malloc.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iostream>

namespace raypick::bench {

namespace {

// A line of /proc/self/status, in bytes.
double status_bytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    std::string word;
    double kilobytes = 0.0;
    while (status >> word) {
        if (word == key + ":") {
            status >> kilobytes;
            return 1024.0 * kilobytes;
        }
    }
    return 0.0;
}

// From here on the kernel's peak is the peak since here. Freed memory goes back first, so that a
// build doesn't hide in what reading the file has left.
double begin_weighing() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << '5';
    return status_bytes("VmRSS");
}

struct Weight {
    double claimed = 0.0;   // by the tree itself
    double resident = 0.0;  // what the process has grown by
    double peak = 0.0;      // what it had grown by at most
};

Weight end_weighing(double before, double claimed) {
    const double peak = status_bytes("VmHWM") - before;
    malloc_trim(0);
    return {claimed, status_bytes("VmRSS") - before, peak};
}

Weight weigh_ours(const View& view) {
    const double before = begin_weighing();
    const Accel accel(view.scene);
    return end_weighing(before, static_cast<double>(accel.stats().bytes));
}

#ifdef RAYPICK_HAS_EMBREE
Weight weigh_embree(const View& view) {
    EmbreeScene scene(view.scene, {});
    const auto arrays = static_cast<double>(scene.bytes());
    const double before = begin_weighing();
    scene.commit();
    return end_weighing(before, static_cast<double>(scene.bytes()) - arrays);
}
#endif

struct Weighed {
    double triangles = 0.0;
    Weight weight;
};

std::optional<Weighed> weigh_in_child(const std::string& model, const std::string& builder,
                                      Report& report) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    const CommandResult result =
        run_shell(fmt::format("'{}' --weigh={},{} --models='{}'", self, model, builder,
                              report.options().models.string()));
    const std::size_t start = result.out.find('{');
    if (result.exit_code != 0 || start == std::string::npos) {
        report.wrong(fmt::format("memory/{}: {}", model, result.out));
        return std::nullopt;
    }
    const auto json = nlohmann::json::parse(result.out.substr(start));
    return Weighed{json["triangles"], {json["claimed"], json["resident"], json["peak"]}};
}

Figure figure(const std::string& name, const std::vector<double>& values) {
    return {name, summary(values), "B"};
}

// Rows of one builder: bytes a triangle.
void add_rows(const std::string& name, const std::vector<Weighed>& rounds, bool ours,
              Report& report) {
    std::vector<double> claimed;
    std::vector<double> resident;
    std::vector<double> peak;
    for (const Weighed& weighed : rounds) {
        claimed.push_back(weighed.weight.claimed / weighed.triangles);
        resident.push_back(weighed.weight.resident / weighed.triangles);
        peak.push_back(weighed.weight.peak / weighed.triangles);
    }
    Row rest;
    rest.name = name + "/resident";
    rest.figures = {figure("process grew by", resident)};
    rest.result_name = "tree, a triangle";
    rest.result = summary(claimed);
    Row most;
    most.name = name + "/peak";
    most.result_name = "build's peak, a triangle";
    most.result = summary(peak);
    for (Row* row : {&rest, &most})
        row->result_unit = "B";
    if (ours) {
        rest.target = Target{40.0, 20.0, true};
        most.target = Target{80.0, 50.0, true};
    }
    report.add(rest);
    report.add(most);
}

void measure_builder(const std::string& model, const std::string& builder, Report& report) {
    const bool ours = builder == "ours";
    const std::string name = fmt::format("memory/{}{}", model, ours ? "" : "/embree");
    if (!report.wants_any({name + "/resident", name + "/peak"})) return;
    if (!model_file(model, report)) return;
    std::vector<Weighed> rounds;
    for (int round = 0; round < (report.options().smoke ? 1 : 3); ++round) {
        const auto weighed = weigh_in_child(model, builder, report);
        if (!weighed) return;
        rounds.push_back(*weighed);
    }
    add_rows(name, rounds, ours, report);
}

}  // namespace

int build_and_weigh(const std::string& model, const std::string& builder, const Options& options) {
    std::ostringstream silence;
    std::streambuf* out = std::cout.rdbuf(silence.rdbuf());
    Report report(options);
    const std::optional<View> view = open_view(model, report);
    std::cout.rdbuf(out);
    if (!view) return 1;
    Weight weight;
    if (builder == "ours") weight = weigh_ours(*view);
#ifdef RAYPICK_HAS_EMBREE
    if (builder == "embree") weight = weigh_embree(*view);
#endif
    double triangles = 0.0;
    for (const Object& object : view->scene->objects)
        triangles += primitive_count(*view->scene, object);
    std::cout << nlohmann::json{{"triangles", triangles},
                                {"claimed", weight.claimed},
                                {"resident", weight.resident},
                                {"peak", weight.peak}};
    return 0;
}

void run_memory(Report& report) {
    for (const char* model : {"bunny", "sponza", "kitchen", "scopia"}) {
        if (report.options().smoke && model != std::string("bunny")) continue;
        measure_builder(model, "ours", report);
#ifdef RAYPICK_HAS_EMBREE
        measure_builder(model, "embree", report);
#endif
    }
}

}  // namespace raypick::bench
