#include "viewer/cli/open_scene.h"

#include "tracer/io/load.h"
#include "viewer/cli/exit_code.h"

#include <fmt/format.h>

#include <chrono>

namespace raypick {
namespace {

class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

OpenedScene load_timed(const SceneOptions& options, const std::stop_token& stop) {
    const Stopwatch watch;
    LoadOptions load;
    load.crease_degrees = options.crease_degrees;
    load.stop = stop;
    LoadedScene loaded = load_scene(options.file, load);
    OpenedScene opened;
    opened.load_seconds = watch.seconds();
    opened.warnings = std::move(loaded.warnings);
    opened.scene = std::make_shared<const Scene>(std::move(loaded.scene));
    return opened;
}

void print_report(const OpenedScene& opened, const SceneOptions& options) {
    for (const std::string& warning : opened.warnings)
        print_message("warning: " + warning);
    if (options.verbose) {
        print_message(fmt::format("loaded {}: {} objects in {:.3f} s", options.file.string(),
                                  opened.scene->objects.size(), opened.load_seconds));
    }
}

OpenedScene open_scene(const SceneOptions& options) {
    OpenedScene opened = load_timed(options);
    print_report(opened, options);
    return opened;
}

BuiltAccel build_timed(const OpenedScene& opened, const BuildOptions& options) {
    const Stopwatch watch;
    BuiltAccel built;
    built.accel = std::make_shared<const Accel>(opened.scene, options);
    built.build_seconds = watch.seconds();
    return built;
}

void print_report(const BuiltAccel& built) {
    const AccelStats stats = built.accel->stats();
    print_message(fmt::format("built the tree: {} triangles, {} nodes, {} bytes in {:.3f} s",
                              stats.triangles, stats.nodes, stats.bytes, built.build_seconds));
}

Camera camera_for(const Scene& scene, ImageSize size, const CameraOverride& wanted) {
    const bool overridden =
        wanted.eye || wanted.at || wanted.up || wanted.fovy || wanted.projection || wanted.height;
    if (!overridden) return choose_camera(scene, size, wanted);
    try {
        return choose_camera(scene, size, wanted);
    } catch (const Error& error) {
        throw UsageError(
            fmt::format("--eye, --look-at, --up, --fovy, --orthographic: {}", error.what()));
    }
}

}  // namespace raypick
