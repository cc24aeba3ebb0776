#include "tests/bench/command.h"
#include "tests/bench/groups.h"
#include "tests/bench/scenes.h"
#include "tests/bench/screen.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace raypick::bench {

namespace {

struct Model {
    const char* name;
    const char* path;
};

constexpr std::array<Model, 5> kModels{{
    {"bunny.ply", "stanford/bunny_binary.ply"},
    {"sponza.obj", "sponza/sponza.obj"},
    {"motorBike.obj", "openfoam/motorBike.obj"},
    {"kitchen.glb", "bitterli/kitchen.glb"},
    {"UltimakerRobot_support.stl", "cura/UltimakerRobot_support.stl"},
}};

constexpr Target kTarget{1.2, 3.0};

std::string resolution() {
    return fmt::format("{},{}", Screen::kCols, Screen::kRows);
}

// From start to end of a program that leaves a PNG.
double until_png(const std::string& command, const std::filesystem::path& png) {
    std::filesystem::remove(png);
    const CommandResult result = run_shell(command);
    if (result.exit_code != 0 || !std::filesystem::exists(png)) {
        throw std::runtime_error(command + ": " + result.out);
    }
    return result.seconds;
}

// What the window shows when all is loaded.
Screen::Picture final_picture(const std::vector<std::string>& words, const Screen& screen,
                              bool smoke) {
    screen.wait_until_empty();
    const Child child(words, screen.display());
    return screen.wait_until_still(smoke ? 1.5 : 5.0);
}

// From start to the first frame of the window that shows this.
double until_window(const std::vector<std::string>& words, const Screen& screen,
                    const Screen::Picture& wanted) {
    screen.wait_until_empty();
    std::optional<Child> child;  // its end is not timed
    return seconds_of([&] {
        child.emplace(words, screen.display());
        screen.wait_for(wanted);
    });
}

Contender window_contender(const std::string& name, const std::vector<std::string>& words,
                           const Screen& screen, bool smoke) {
    const auto wanted = std::make_shared<Screen::Picture>();
    return {name, [words, &screen, wanted, smoke] {
                if (wanted->empty()) *wanted = final_picture(words, screen, smoke);
                return until_window(words, screen, *wanted);
            }};
}

std::vector<Contender> png_contenders(const std::filesystem::path& model, const Options& options,
                                      const Screen& screen) {
    const std::filesystem::path png = std::filesystem::absolute("load.png");
    const std::string environment = "DISPLAY=" + screen.display();
    const std::string ours =
        fmt::format("{} '{}' render '{}' --raster --output='{}' --resolution={}", environment,
                    options.program.string(), model.string(), png.string(), resolution());
    const std::string theirs = fmt::format("{} f3d --dry-run '{}' --output='{}' --resolution={}",
                                           environment, model.string(), png.string(), resolution());
    return {{"ours", [ours, png] { return until_png(ours, png); }},
            {"f3d", [theirs, png] { return until_png(theirs, png); }}};
}

std::vector<Contender> window_contenders(const std::filesystem::path& model, const Options& options,
                                         const Screen& screen) {
    const std::vector<std::string> ours{options.program.string(), "view", model.string(),
                                        "--resolution=" + resolution()};
    const std::vector<std::string> theirs{"f3d", "--dry-run", model.string(),
                                          "--resolution=" + resolution()};
    return {window_contender("ours", ours, screen, options.smoke),
            window_contender("f3d", theirs, screen, options.smoke)};
}

// Reading the file into the cache is nobody's work.
void warm_up(const std::vector<Contender>& contenders) {
    for (const Contender& contender : contenders)
        contender.run();
}

void measure(const std::string& name, const std::vector<Contender>& contenders, Report& report) {
    if (!report.wants(name)) return;
    try {
        warm_up(contenders);
    } catch (const std::exception& error) {
        report.wrong(fmt::format("{}: {}", name, error.what()));
        return;
    }
    const std::vector<Timing> timings = alternate(contenders, report.options().rounds);
    Row row;
    row.name = name;
    row.figures = in_milliseconds(timings);
    if (timings.size() == 2) {
        row.result_name = "f3d / ours";
        row.result = ratio(timings[1], timings[0]);
        row.target = kTarget;
    }
    report.add(row);
}

bool all_there(Report& report) {
    if (!std::filesystem::exists(report.options().program)) {
        report.missing("raypick, the program (RAYPICK_BUILD_VIEWER)");
        return false;
    }
    for (const char* program : {"f3d", "Xvfb"}) {
        if (has_program(program)) continue;
        report.missing(program);
        return false;
    }
    return true;
}

}  // namespace

void run_loads(Report& report) {
    std::vector<std::string> names;
    for (const Model& model : kModels) {
        names.push_back(fmt::format("loads/{}/png", model.name));
        names.push_back(fmt::format("loads/{}/window", model.name));
    }
    if (!report.wants_any(names) || !all_there(report)) return;
    const Screen screen;
    const std::size_t count = report.options().smoke ? 1 : kModels.size();
    for (std::size_t i = 0; i < count; ++i) {
        const auto file = model_file(kModels[i].path, report);
        if (!file) continue;
        measure(names[2 * i], png_contenders(*file, report.options(), screen), report);
        measure(names[2 * i + 1], window_contenders(*file, report.options(), screen), report);
    }
}

}  // namespace raypick::bench
