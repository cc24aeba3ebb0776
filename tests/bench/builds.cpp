#include "tests/bench/embree_scene.h"
#include "tests/bench/groups.h"
#include "tests/bench/scenes.h"
#include "tracer/accel/accel.h"

#include <fmt/format.h>

#include <array>

namespace raypick::bench {

namespace {

// Ours: the tree that picks work with at once, and the one that frames are traced with.
enum class OurTree { first, quality };

double build_ours(const View& view, OurTree tree, int threads) {
    BuildOptions options;
    options.threads = threads;
    options.quality = tree == OurTree::first ? TreeQuality::first : TreeQuality::many_rays;
    std::unique_ptr<Accel> accel;
    return seconds_of([&] { accel = std::make_unique<Accel>(view.scene, options); });
}

#ifdef RAYPICK_HAS_EMBREE
// Without the time in which Embree is given the arrays. The device goes with it: while it is there
// all of the process has no more threads than it has.
double build_embree(const View& view, const EmbreeSettings& settings) {
    EmbreeScene scene(view.scene, settings);
    return seconds_of([&] { scene.commit(); });
}
#endif

Contender ours(const View& view, OurTree tree, int threads) {
    return {"ours", [&view, tree, threads] { return build_ours(view, tree, threads); }};
}

std::vector<Contender> theirs(const View& view, EmbreeQuality quality, const Options& options,
                              int threads) {
#ifdef RAYPICK_HAS_EMBREE
    EmbreeSettings settings;
    settings.quality = quality;
    settings.isa = options.isa;
    settings.threads = threads;
    const char* name = quality == EmbreeQuality::low ? "Embree low" : "Embree medium";
    return {{name, [&view, settings] { return build_embree(view, settings); }}};
#else
    static_cast<void>(view);
    static_cast<void>(quality);
    static_cast<void>(options);
    static_cast<void>(threads);
    return {};
#endif
}

double million_primitives(const Scene& scene) {
    std::size_t count = 0;
    for (const Object& object : scene.objects)
        count += primitive_count(scene, object);
    return static_cast<double>(count) * 1e-6;
}

Row measure(const View& view, const std::vector<Contender>& contenders, int threads, int rounds) {
    for (const Contender& contender : contenders)
        contender.run();
    const std::vector<Timing> timings = alternate(contenders, rounds);
    Row row;
    row.threads = threads;
    for (const Timing& timing : timings) {
        std::vector<double> rates;
        for (const double seconds : timing.seconds)
            rates.push_back(million_primitives(*view.scene) / seconds);
        row.figures.push_back({timing.name, summary(rates), "M/s"});
    }
    if (timings.size() == 2) {
        row.result_name = fmt::format("{} / ours", timings[1].name);
        row.result = ratio(timings[1], timings[0]);
    }
    return row;
}

void measure_tree(const View& view, OurTree tree, Report& report) {
    const bool first = tree == OurTree::first;
    const std::string name = fmt::format("builds/{}/{}", view.name, first ? "first" : "quality");
    if (!report.wants(name)) return;
    const EmbreeQuality quality = first ? EmbreeQuality::low : EmbreeQuality::medium;
    for (const int threads : report.options().threads) {
        std::vector<Contender> contenders{ours(view, tree, threads)};
        for (Contender& peer : theirs(view, quality, report.options(), threads))
            contenders.push_back(std::move(peer));
        Row row = measure(view, contenders, threads, report.options().rounds);
        row.name = name;
        row.target = first ? Target{0.8, 1.2} : Target{1.0, 2.0};
        report.add(row);
    }
}

}  // namespace

void run_builds(Report& report) {
    for (const char* scene : {"bunny", "sponza", "kitchen", "scopia"}) {
        if (report.options().smoke && scene != std::string("bunny")) continue;
        const std::string row = fmt::format("builds/{}/", scene);
        if (!report.wants_any({row + "first", row + "quality"})) continue;
        const std::optional<View> view = open_view(scene, report);
        if (!view) continue;
        measure_tree(*view, OurTree::first, report);
        measure_tree(*view, OurTree::quality, report);
    }
}

}  // namespace raypick::bench
