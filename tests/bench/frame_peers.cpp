#include "tests/bench/frame_peers.h"

#include "tests/bench/command.h"
#include "tests/bench/tachyon_scene.h"
#include "tests/pov_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace raypick::bench {

namespace {

std::filesystem::path folder_for(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::absolute("bench-" + name);
    std::filesystem::create_directories(folder);
    return folder;
}

// The number that stands in the program's output behind the last `label`, and behind `before`
// there.
double number_behind(const CommandResult& result, const std::string& label,
                     const std::string& before) {
    const std::size_t line = result.out.rfind(label);
    if (result.exit_code != 0 || line == std::string::npos) throw std::runtime_error(result.out);
    const std::size_t start = result.out.find(before, line + label.size());
    if (start == std::string::npos) throw std::runtime_error(result.out);
    return std::stod(result.out.substr(start + before.size()));
}

// Its own settings as they are, but for smoothing, windows and files: "Trace Time: 0 hours
// 0 minutes 1 seconds (1.234 seconds)".
std::function<double(int)> prepare_povray(const View& view, ImageSize size,
                                          const RenderSettings& settings) {
    const std::filesystem::path folder = folder_for("povray");
    write_pov_scene(folder, *view.scene, view.camera, size, settings, 1);
    return [folder, size](int threads) {
        const CommandResult result =
            run_shell(fmt::format("cd '{}' && povray +Iscene.pov -F -D -A +Q9 +WT{} +W{} +H{}",
                                  folder.string(), threads, size.cols, size.rows));
        return number_behind(result, "Trace Time:", "(");
    };
}

// "Ray Tracing Time: 1.2345 seconds".
std::function<double(int)> prepare_tachyon(const View& view, ImageSize size,
                                           const RenderSettings& settings) {
    const std::filesystem::path file = folder_for("tachyon") / "scene.dat";
    write_tachyon_scene(file, *view.scene, view.camera, settings.depth);
    return [file, size](int threads) {
        const CommandResult result =
            run_shell(fmt::format("tachyon '{}' -res {} {} -numthreads {} -nosave", file.string(),
                                  size.cols, size.rows, threads));
        return number_behind(result, "Ray Tracing Time:", " ");
    };
}

}  // namespace

std::vector<FramePeer> frame_peers(Report& report) {
    std::vector<FramePeer> peers;
    if (has_program("povray")) {
        peers.push_back({"povray", prepare_povray});
    } else {
        report.missing("POV-Ray (povray)");
    }
    if (has_program("tachyon")) {
        peers.push_back({"tachyon", prepare_tachyon});
    } else {
        report.missing("Tachyon (tachyon-bin-nox)");
    }
    return peers;
}

}  // namespace raypick::bench
