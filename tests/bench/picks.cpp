#include "picking/pick.h"
#include "tests/bench/groups.h"
#include "tests/bench/scenes.h"
#include "tests/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace raypick::bench {

namespace {

// Random ones of those that show something: a pick that misses costs next to nothing.
std::vector<Pixel> random_pixels(const Accel& accel, const View& view, ImageSize size,
                                 std::size_t count) {
    Random random(3);
    std::vector<Pixel> pixels;
    while (pixels.size() < count) {
        Pixel pixel;
        pixel.row = static_cast<int>(random.below(static_cast<std::size_t>(size.rows)));
        pixel.col = static_cast<int>(random.below(static_cast<std::size_t>(size.cols)));
        if (accel.intersect(camera_ray(view.camera, size, pixel))) pixels.push_back(pixel);
    }
    return pixels;
}

// Memory that takes the caches' place when it is written to.
class Broom {
public:
    void sweep() {
        // Nobody reads it; volatile makes the compiler write all the same.
        volatile std::uint64_t* memory = memory_.data();
        for (std::size_t i = 0; i < memory_.size(); i += 8)
            memory[i] = i;
    }

private:
    std::vector<std::uint64_t> memory_ = std::vector<std::uint64_t>((64u << 20u) / 8);
};

// What each pick takes, in microseconds, the clock's own time taken off.
std::vector<double> time_picks(const Accel& accel, const View& view, ImageSize size,
                               const std::vector<Pixel>& pixels, Broom* broom) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> times;
    times.reserve(pixels.size());
    std::size_t found = 0;
    double clock = 1e9;
    for (int i = 0; i < 1000; ++i) {
        const auto start = Clock::now();
        clock = std::min(clock,
                         std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
    for (const Pixel pixel : pixels) {
        if (broom != nullptr) broom->sweep();
        const auto start = Clock::now();
        found += pick_pixel(accel, view.camera, size, pixel) ? 1 : 0;
        const auto end = Clock::now();
        times.push_back(std::chrono::duration<double, std::micro>(end - start).count() - clock);
    }
    if (found != pixels.size()) throw std::runtime_error("a pick finds nothing");
    return times;
}

// One figure a round of all the picks' times: their median or their 99 %.
Row row_of(const std::string& name, const std::vector<std::vector<double>>& rounds, double share,
           const Target* target) {
    std::vector<double> values;
    values.reserve(rounds.size());
    for (const std::vector<double>& times : rounds)
        values.push_back(quantile(times, share));
    Row row;
    row.name = name;
    row.threads = 1;
    row.result_name = "one pick";
    row.result = summary(values);
    row.result_unit = "us";
    if (target != nullptr) row.target = *target;
    return row;
}

void measure_scene(const std::string& scene, Report& report) {
    const std::string start = fmt::format("picks/{}/", scene);
    if (!report.wants_any({start + "warm/median", start + "warm/p99", start + "cold/median"}))
        return;
    const std::optional<View> view = open_view(scene, report);
    if (!view) return;
    const Accel accel(view->scene);
    const Options& options = report.options();
    const auto warm_pixels =
        random_pixels(accel, *view, options.size, options.smoke ? 500 : 10'000);
    const auto cold_pixels = random_pixels(accel, *view, options.size, options.smoke ? 20 : 200);
    Broom broom;
    std::vector<std::vector<double>> warm;
    std::vector<std::vector<double>> cold;
    for (int round = 0; round < options.rounds; ++round) {
        time_picks(accel, *view, options.size, warm_pixels, nullptr);
        warm.push_back(time_picks(accel, *view, options.size, warm_pixels, nullptr));
        cold.push_back(time_picks(accel, *view, options.size, cold_pixels, &broom));
    }
    constexpr Target kMedian{1.5, 0.7, true};
    constexpr Target kWorst{6.0, 3.0, true};
    report.add(row_of(start + "warm/median", warm, 0.5, &kMedian));
    report.add(row_of(start + "warm/p99", warm, 0.99, &kWorst));
    report.add(row_of(start + "cold/median", cold, 0.5, nullptr));
}

}  // namespace

void run_picks(Report& report) {
    for (const char* scene : {"bunny", "sponza", "kitchen", "scopia"}) {
        if (report.options().smoke && scene != std::string("bunny")) continue;
        measure_scene(scene, report);
    }
}

}  // namespace raypick::bench
