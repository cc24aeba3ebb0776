#include "tests/bench/embree_scene.h"
#include "tests/bench/groups.h"
#include "tests/bench/modes.h"
#include "tests/bench/ray_sets.h"
#include "tests/bench/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace raypick::bench {

namespace {

struct Work {
    const char* name;
    std::vector<Ray> RaySets::*rays;
    bool any_hit;
    bool coherent;
    Target target;
};

constexpr std::array<Work, 4> kWorks{{
    {"primary", &RaySets::primary, false, true, {1.3, 2.0}},
    {"shadow", &RaySets::shadow, true, true, {1.5, 2.2}},
    {"mirror", &RaySets::mirror, false, true, {1.3, 1.6}},
    {"random", &RaySets::random, false, false, {1.1, 1.4}},
}};

constexpr std::array<const char*, 7> kScenes{"bunny",   "sponza", "kitchen", "scopia",
                                             "bunny64", "balls",  "rings"};

Target target_of(const std::string& scene, const Work& work) {
    if (work.rays != &RaySets::primary) return work.target;
    if (scene == "scopia" || scene == "bunny64") return {1.0, 1.3};
    if (scene == "balls" || scene == "rings") return {1.5, 3.0};
    return work.target;
}

std::string row_name(const std::string& scene, const Work& work) {
    return fmt::format("kernels/{}/{}", scene, work.name);
}

// All modes must have met as much, as many times as makes no difference.
bool agree(const std::vector<Mode>& modes, std::size_t count, const std::string& row,
           Report& report) {
    const Tally first = run(modes.front(), count, 1);
    std::string text = fmt::format("{} rays, hits:", count);
    bool good = true;
    for (const Mode& mode : modes) {
        const Tally tally = &mode == &modes.front() ? first : run(mode, count, 1);
        text += fmt::format(" {}{} {}", mode.ours ? "our " : "", mode.name, tally.hits);
        const double most = std::max(3.0, 0.001 * static_cast<double>(count));
        const double apart =
            std::abs(static_cast<double>(tally.hits) - static_cast<double>(first.hits));
        const bool near = std::abs(tally.t - first.t) <= 0.005 * first.t;
        if (apart <= most && near) continue;
        good = false;
        report.wrong(fmt::format("{}: {} hits {} rays at {} in all, ours {} at {}", row, mode.name,
                                 tally.hits, tally.t, first.hits, first.t));
    }
    report.note(row + ": " + text);
    return good;
}

Figure rate_figure(const Mode& mode, const Timing& timing, std::size_t count) {
    std::vector<double> rates;
    for (const double seconds : timing.seconds)
        rates.push_back(static_cast<double>(count) / seconds * 1e-6);
    return {(mode.ours ? "our " : "") + mode.name, summary(rates), "Mrays/s"};
}

// Each mode goes once over the rays before it is timed: else Embree's would find their tree as the
// one before has left it in caches and page tables, and ours theirs as all of Embree's have.
std::vector<Timing> time(const std::vector<Mode>& modes, std::size_t count, int threads,
                         int rounds) {
    std::vector<Contender> contenders;
    for (const Mode& mode : modes) {
        contenders.push_back({mode.name, [&mode, count, threads] {
                                  run(mode, count, threads);
                                  return seconds_of([&] { run(mode, count, threads); });
                              }});
    }
    return alternate(contenders, rounds);
}

Row measure(const std::vector<Mode>& modes, std::size_t count, int threads, int rounds) {
    const std::vector<Timing> timings = time(modes, count, threads, rounds);
    Row row;
    row.threads = threads;
    std::vector<Timing> theirs;
    for (std::size_t i = 0; i < timings.size(); ++i) {
        row.figures.push_back(rate_figure(modes[i], timings[i], count));
        if (!modes[i].ours) theirs.push_back(timings[i]);
    }
    if (const auto best = fastest(theirs)) {
        row.result_name = "ours / " + best->name;
        row.result = ratio(*best, timings.front());
    }
    return row;
}

// One scene with its trees, ours and Embree's.
struct Arena {
    View view;
    std::unique_ptr<Accel> accel;
    std::shared_ptr<const EmbreeScene> embree;
    RaySets rays;
};

std::shared_ptr<const EmbreeScene> embree_of(const View& view, const Options& options) {
#ifdef RAYPICK_HAS_EMBREE
    EmbreeSettings settings;
    settings.isa = options.isa;
    const auto scene = std::make_shared<EmbreeScene>(view.scene, settings);
    scene->commit();
    return scene;
#else
    static_cast<void>(view);
    static_cast<void>(options);
    return nullptr;
#endif
}

std::optional<Arena> open_arena(const std::string& scene, Report& report) {
    std::optional<View> view = open_view(scene, report);
    if (!view) return std::nullopt;
    Arena arena;
    arena.view = std::move(*view);
    arena.accel = std::make_unique<Accel>(arena.view.scene);
    arena.embree = embree_of(arena.view, report.options());
    arena.rays = make_ray_sets(*arena.accel, arena.view, report.options().size);
    return arena;
}

void measure_work(const Arena& arena, const Work& work, Report& report) {
    const std::string name = row_name(arena.view.name, work);
    const std::vector<Ray>& rays = arena.rays.*work.rays;
    if (!report.wants(name) || rays.empty()) return;
    const RayList list{rays, work.any_hit, arena.view.light, work.coherent};
    std::vector<Mode> modes = our_modes(*arena.accel, list);
    for (Mode& mode : embree_modes(arena.embree, list))
        modes.push_back(std::move(mode));
    if (!agree(modes, rays.size(), name, report)) return;
    for (const int threads : report.options().threads) {
        Row row = measure(modes, rays.size(), threads, report.options().rounds);
        row.name = name;
        row.target = target_of(arena.view.name, work);
        report.add(row);
    }
}

void measure_scene(const std::string& scene, Report& report) {
    std::vector<std::string> names;
    for (const Work& work : kWorks)
        names.push_back(row_name(scene, work));
    if (!report.wants_any(names)) return;
    const std::optional<Arena> arena = open_arena(scene, report);
    if (!arena) return;
    for (const Work& work : kWorks)
        measure_work(*arena, work, report);
}

// Time of the fine mesh over time of the coarse one, for the fastest kind of each builder.
Row growth_row(const std::string& who, const Mode& coarse, const Mode& fine, std::size_t count,
               int threads, int rounds) {
    std::vector<Mode> modes{coarse, fine};
    modes[0].name = who + ", 69 k";
    modes[1].name = who + ", 4.4 M";
    for (Mode& mode : modes)
        mode.ours = false;
    const std::vector<Timing> timings = time(modes, count, threads, rounds);
    Row row;
    row.threads = threads;
    for (std::size_t i = 0; i < timings.size(); ++i)
        row.figures.push_back(rate_figure(modes[i], timings[i], count));
    row.result_name = who + ": 4.4 M / 69 k";
    row.result = ratio(timings[1], timings[0]);
    row.result_unit = "x time";
    return row;
}

// The same rays through a mesh and through one of 64 times as many triangles.
void measure_growth(Report& report) {
    const std::string name = "kernels/growth/primary";
    if (!report.wants(name)) return;
    const std::optional<Arena> coarse = open_arena("bunny", report);
    const std::optional<Arena> fine = open_arena("bunny64", report);
    if (!coarse || !fine) return;
    const RayList list{coarse->rays.primary};
    const int rounds = report.options().rounds;
    for (const int threads : report.options().threads) {
        Row ours =
            growth_row("ours", our_modes(*coarse->accel, list).front(),
                       our_modes(*fine->accel, list).front(), list.rays.size(), threads, rounds);
        ours.name = name;
        ours.target = Target{5.0, 3.0, true};
        report.add(ours);
        const std::vector<Mode> few = embree_modes(coarse->embree, list);
        const std::vector<Mode> many = embree_modes(fine->embree, list);
        if (few.empty()) continue;
        Row theirs = growth_row("Embree streams", few.back(), many.back(), list.rays.size(),
                                threads, rounds);
        theirs.name = name + "/embree";
        report.add(theirs);
    }
}

}  // namespace

void run_kernels(Report& report) {
    for (const char* scene : kScenes) {
        const bool small = scene == std::string("bunny") || scene == std::string("rings");
        if (!report.options().smoke || small) measure_scene(scene, report);
    }
    if (!report.options().smoke) measure_growth(report);
}

}  // namespace raypick::bench
