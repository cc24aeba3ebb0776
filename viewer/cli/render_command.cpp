#include "tracer/parallel/parallel.h"
#include "tracer/render/render_job.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/interrupt.h"
#include "viewer/cli/open_scene.h"
#include "viewer/cli/progress_bar.h"
#include "viewer/cli/raster_start.h"
#include "viewer/cli/render_output.h"
#include "viewer/cli/scene_report.h"
#include "viewer/cli/standard_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <thread>
#include <vector>

namespace raypick {
namespace {

using Clock = std::chrono::steady_clock;

struct Frame {
    Image image;
    RayCounts rays;  // none if drawn by OpenGL
    std::uint64_t nan_pixels = 0;
    double build_seconds = 0.0;  // of the tree that rays run on
    double seconds = 0.0;        // of the frame
    std::uint64_t accel_bytes = 0;
};

// PNG holds colour alone, of all that an image has.
bool writes_png(const RenderCommand& command) {
    return command.output == "-" || is_png_name(command.output);
}

void show_progress(const RenderJob& job, ProgressBar& bar) {
    for (RenderProgress progress = job.progress(); !progress.finished; progress = job.progress()) {
        const auto rays = static_cast<double>(progress.rays.total());
        const double mega_rays_per_second =
            progress.seconds > 0.0 ? 1e-6 * rays / progress.seconds : 0.0;
        bar.show("tracing", progress.fraction,
                 fmt::format("{:.1f} s, {:.2f} Mrays/s", progress.seconds, mega_rays_per_second));
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
    }
    bar.clear();
}

Frame traced(const RenderCommand& command, const OpenedScene& opened, const Camera& camera,
             const Interrupt& interrupt, ProgressBar& bar) {
    bar.show("building the tree");
    const BuiltAccel built =
        build_timed(opened, {.threads = command.settings.threads, .stop = interrupt.token()});
    bar.clear();
    if (command.scene.verbose) print_report(built);
    const RenderPlan plan{.progressive = false,  // nobody looks at it before it is done
                          .channels = writes_png(command) ? Channels::colour : Channels::all};
    RenderJob job(built.accel, camera, command.size, command.settings, plan);
    const std::stop_callback cancel(interrupt.token(), [&job] { job.cancel(); });
    if (bar.visible()) show_progress(job, bar);
    job.wait();
    interrupt.check();

    Frame frame;
    const RenderProgress progress = job.progress();
    frame.rays = progress.rays;
    frame.nan_pixels = progress.nan_pixels;
    frame.build_seconds = built.build_seconds;
    frame.seconds = progress.seconds;
    frame.accel_bytes = built.accel->stats().bytes;
    frame.image = job.take_image();
    return frame;
}

Frame rasterized(const RenderCommand& command, const OpenedScene& opened, const Camera& camera,
                 RasterStart& raster) {
    const OffscreenContext& context = raster.context();
    if (command.scene.verbose) print_message("OpenGL: " + context.description());
    const auto start = Clock::now();
    Rasterizer& rasterizer = raster.rasterizer();
    rasterizer.set_scene(opened.scene);
    for (const std::string& warning : rasterizer.warnings())
        print_message("warning: " + warning);
    rasterizer.draw(camera, command.size);
    Frame frame;
    frame.image = writes_png(command) ? rasterizer.read_colour() : rasterizer.read_image();
    frame.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return frame;
}

std::uint64_t image_bytes(const Image& image) {
    const auto bytes = [](const auto& channel) { return channel.size() * sizeof(channel[0]); };
    return bytes(image.colour) + bytes(image.depth) + bytes(image.normal) + bytes(image.object) +
           bytes(image.primitive);
}

// Counts by the depth of the ray, beginning with the eye's rays at depth 1, down to what the
// settings allow.
Json rays_json(const RayCounts& rays, int depth) {
    const auto deepest = static_cast<std::ptrdiff_t>(std::min(depth, kMaxDepth));
    const auto by_depth = [&](const auto& counts) {
        return Json(std::vector<std::uint64_t>(counts.begin() + 1, counts.begin() + 1 + deepest));
    };
    return {{"eye", rays.eye},
            {"eye_hits", rays.eye_hits},
            {"reflection", rays.reflection},
            {"refraction", rays.refraction},
            {"shadow", rays.shadow},
            {"shadow_blocked", rays.shadow_blocked},
            {"by_depth",
             {{"reflection", by_depth(rays.reflection_at)},
              {"refraction", by_depth(rays.refraction_at)},
              {"shadow", by_depth(rays.shadow_at)}}}};
}

Json stats_json(const RenderCommand& command, const OpenedScene& opened, const Frame& frame) {
    Json json;
    json["seconds"] = {{"load", opened.load_seconds},
                       {"build", frame.build_seconds},
                       {"trace", command.raster ? 0.0 : frame.seconds},
                       {"raster", command.raster ? frame.seconds : 0.0}};
    json["rays"] = rays_json(frame.rays, command.settings.depth);
    json["nan_pixels"] = frame.nan_pixels;
    add_counts(json, *opened.scene);
    json["memory_bytes"] = {{"meshes", mesh_bytes(*opened.scene)},
                            {"accel", frame.accel_bytes},
                            {"image", image_bytes(frame.image)},
                            {"peak", peak_memory_bytes()}};
    json["resolution"] = {command.size.cols, command.size.rows};
    return json;
}

// Loads, and makes OpenGL ready at the same time if it is going to draw.
OpenedScene load(const RenderCommand& command, const Interrupt& interrupt,
                 std::optional<RasterStart>& raster) {
    if (!command.raster) return load_timed(command.scene, interrupt.token());
    count_cores();
    std::future<OpenedScene> loading = std::async(
        std::launch::async, [&] { return load_timed(command.scene, interrupt.token()); });
    raster.emplace(command.size);
    return loading.get();
}

Frame make_frame(const RenderCommand& command, const OpenedScene& opened,
                 const Interrupt& interrupt, ProgressBar& bar, std::optional<RasterStart>& raster) {
    const Camera camera = camera_for(*opened.scene, command.size, command.camera);
    return raster ? rasterized(command, opened, camera, *raster)
                  : traced(command, opened, camera, interrupt, bar);
}

void render_to(const RenderOutput& output, const RenderCommand& command,
               const Interrupt& interrupt) {
    ProgressBar bar;
    bar.show("loading");
    std::optional<RasterStart> raster;
    const OpenedScene opened = load(command, interrupt, raster);
    bar.clear();
    print_report(opened, command.scene);
    const Frame frame = make_frame(command, opened, interrupt, bar, raster);
    bar.clear();
    interrupt.check();
    output.write(frame.image);
    if (frame.nan_pixels > 0) {
        print_message(fmt::format("warning: {} pixels came out as no number and are black",
                                  frame.nan_pixels));
    }
    if (command.scene.verbose) {
        print_message(
            fmt::format("wrote {} after {:.3f} s for the frame", command.output, frame.seconds));
    }
    if (!command.json_stats) return;
    StandardOutput standard_output;
    standard_output.write(dump(stats_json(command, opened, frame)) + "\n");
    standard_output.flush();
}

// The image, what its pixels need while they are made, and the file's bytes. Found before loading,
// because asking for too much memory may end in a process being killed instead of in an error.
void check_memory(const RenderCommand& command) {
    const ImageSize size = command.size;
    const double bytes_per_pixel = writes_png(command) && !command.raster ? 32.0 : 80.0;
    const double needed = bytes_per_pixel * static_cast<double>(size.pixel_count());
    const double installed =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    if (needed <= installed) return;
    throw Error(
        fmt::format("an image of {} x {} pixels needs {:.0f} GB of memory, this machine "
                    "has {:.0f} GB; ask for a smaller --resolution",
                    size.cols, size.rows, 1e-9 * needed, 1e-9 * installed));
}

}  // namespace

int run_render(const RenderCommand& command) {
    check_memory(command);
    const RenderOutput output(command.output, command.size);
    const Interrupt interrupt;
    try {
        render_to(output, command, interrupt);
    } catch (const Cancelled&) {
        interrupt.check();
        throw;
    }
    return kExitOk;
}

}  // namespace raypick
