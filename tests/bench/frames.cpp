#include "tests/bench/embree_renderer.h"
#include "tests/bench/frame_peers.h"
#include "tests/bench/groups.h"
#include "tests/bench/scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/render/image.h"
#include "tracer/render/render_job.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>

namespace raypick::bench {

namespace {

using Colours = std::vector<glm::vec3>;

RenderSettings with_threads(RenderSettings settings, int threads) {
    settings.threads = threads;
    return settings;
}

Figure figure(const Timing& timing) {
    std::vector<double> times;
    for (const double seconds : timing.seconds)
        times.push_back(1000.0 * seconds);
    return {timing.name, summary(times), "ms"};
}

// Against the renderer on Embree, in the same rounds by each number of threads.
struct FrameDuel {
    const View& view;
    std::shared_ptr<const Accel> accel;
    RenderSettings settings;
    std::vector<Timing> ours;    // by number of threads
    std::vector<Timing> theirs;  // empty: no Embree
};

Contender our_frame(const FrameDuel& duel, ImageSize size, int threads) {
    return {"ours", [&duel, size, threads] {
                return seconds_of([&] {
                    render(duel.accel, duel.view.camera, size, with_threads(duel.settings, threads),
                           Channels::colour);
                });
            }};
}

Row duel_row(const Timing& ours, const Timing* theirs, int threads) {
    Row row;
    row.threads = threads;
    row.figures.push_back(figure(ours));
    if (theirs != nullptr) {
        row.figures.push_back(figure(*theirs));
        row.result_name = theirs->name + " / ours";
        row.result = ratio(*theirs, ours);
    }
    return row;
}

#ifdef RAYPICK_HAS_EMBREE

// Mean difference of the two pictures' channels, of what can be shown (0 to 1).
double mean_difference(const Colours& a, const Colours& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            sum += static_cast<double>(std::abs(std::min(a[i][k], 1.0f) - std::min(b[i][k], 1.0f)));
    }
    return sum / (3.0 * static_cast<double>(a.size()));
}

std::unique_ptr<EmbreeRenderer> embree_renderer(const View& view, const Options& options) {
    EmbreeSettings settings;
    settings.isa = options.isa;
    const auto scene = std::make_shared<EmbreeScene>(view.scene, settings);
    scene->commit();
    return std::make_unique<EmbreeRenderer>(scene, view.camera);
}

// The two must show the same. Ours is kept.
void compare(const FrameDuel& duel, const EmbreeRenderer& theirs, ImageSize size,
             const std::string& name, Report& report) {
    const RenderedFrame frame = render(duel.accel, duel.view.camera, size, duel.settings);
    const double apart = mean_difference(frame.image.colour, theirs.render(size, duel.settings, 1));
    const std::string text = fmt::format(
        "{}: {} x {}, {:.2f} M rays; mean difference to the picture by Embree {:.2f} %", name,
        size.cols, size.rows, static_cast<double>(frame.rays.total()) * 1e-6, 100.0 * apart);
    write_image(frame.image, duel.view.name + ".png");
    report.note(text);
    if (!(apart < 0.02)) report.wrong(text);
}

Contender embree_frame(const EmbreeRenderer& renderer, const FrameDuel& duel, ImageSize size,
                       int threads) {
    return {"recursive on Embree", [&renderer, &duel, size, threads] {
                Colours picture;
                return seconds_of([&] { picture = renderer.render(size, duel.settings, threads); });
            }};
}

#endif

// Contenders come in pairs where there is Embree: ours, theirs, by number of threads.
void fight(FrameDuel& duel, [[maybe_unused]] const std::string& name, Report& report) {
    const Options& options = report.options();
    std::vector<Contender> contenders;
#ifdef RAYPICK_HAS_EMBREE
    const auto renderer = embree_renderer(duel.view, options);
    compare(duel, *renderer, options.size, name, report);
#endif
    for (const int threads : options.threads) {
        contenders.push_back(our_frame(duel, options.size, threads));
#ifdef RAYPICK_HAS_EMBREE
        contenders.push_back(embree_frame(*renderer, duel, options.size, threads));
#endif
    }
    const std::vector<Timing> timings = alternate(contenders, options.rounds);
    for (const Timing& timing : timings)
        (timing.name == "ours" ? duel.ours : duel.theirs).push_back(timing);
}

// How much faster the last number of threads is than the first.
void add_scaling(const FrameDuel& duel, const std::string& name, Report& report) {
    const Options& options = report.options();
    if (options.threads.size() < 2 || options.threads.front() != 1) return;
    Row row;
    row.name = name + "/threads";
    row.threads = options.threads.back();
    row.result_name = fmt::format("{} threads / 1 thread", row.threads);
    row.result = ratio(duel.ours.front(), duel.ours.back());
    if (row.threads == 2) row.target = Target{1.8, 1.95};
    report.add(row);
}

void measure_embree(const std::string& scene, Report& report) {
    const std::string name = "frames/" + scene;
    if (!report.wants_any({name, name + "/threads"})) return;
    const std::optional<View> view = open_view(scene, report);
    if (!view) return;
    FrameDuel duel{*view, std::make_shared<const Accel>(view->scene), {}, {}, {}};
    fight(duel, name, report);
    for (std::size_t i = 0; i < duel.ours.size(); ++i) {
        const Timing* theirs = i < duel.theirs.size() ? &duel.theirs[i] : nullptr;
        Row row = duel_row(duel.ours[i], theirs, report.options().threads[i]);
        row.name = name;
        row.target = Target{2.5, 4.0};
        report.add(row);
    }
    add_scaling(duel, name, report);
}

// Against other programs: the rules that they share with us (no cut-off; light goes through glass),
// their own time for tracing, without start, parsing and saving.
void measure_programs(const std::string& scene, Report& report) {
    const std::string name = "frames/" + scene;
    std::vector<FramePeer> peers = frame_peers(report);
    std::erase_if(peers,
                  [&](const FramePeer& peer) { return !report.wants(name + "/" + peer.name); });
    if (peers.empty()) return;
    const std::optional<View> view = open_view(scene, report);
    if (!view) return;
    FrameDuel duel{*view, std::make_shared<const Accel>(view->scene), {}, {}, {}};
    duel.settings.cutoff = 0.0f;
    duel.settings.glass_shadows = GlassShadows::tinted;
    for (const FramePeer& peer : peers) {
        const auto prepared = peer.prepare(*view, report.options().size, duel.settings);
        for (const int threads : report.options().threads) {
            const std::vector<Timing> timings =
                alternate({our_frame(duel, report.options().size, threads),
                           {peer.name, [&] { return prepared(threads); }}},
                          report.options().rounds);
            if (timings.size() < 2) {
                report.wrong(fmt::format("{}: {} failed", name, peer.name));
                continue;
            }
            Row row = duel_row(timings[0], &timings[1], threads);
            row.name = name + "/" + peer.name;
            row.target = Target{12.0, 25.0};
            report.add(row);
        }
    }
}

}  // namespace

void run_frames(Report& report) {
    const bool smoke = report.options().smoke;
    for (const char* scene : {"balls", "lattice", "bunny_mirror", "sponza_mirror", "kitchen"}) {
        const bool small = scene == std::string("lattice") || scene == std::string("balls");
        if (!smoke || small) measure_embree(scene, report);
    }
    for (const char* scene : {"balls", "lattice"}) {
        if (!smoke || scene == std::string("lattice")) measure_programs(scene, report);
    }
}

}  // namespace raypick::bench
