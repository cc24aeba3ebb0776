#include "viewer/cli/command_options.h"
#include "viewer/cli/option_values.h"
#include "viewer/cli/shared_options.h"

#include <fmt/format.h>

namespace raypick {
namespace {

void read_stream(StreamOf what, PickCommand& command) {
    if (command.stream) throw CLI::ValidationError("standard input can be read only once");
    command.stream = what;
}

void check_inside(const Pixel& pixel, ImageSize size) {
    if (size.contains(pixel)) return;
    throw CLI::ValidationError(
        "--pixel", fmt::format("row {}, column {} is outside the image of {} rows and {} columns",
                               pixel.row, pixel.col, size.rows, size.cols));
}

}  // namespace

void add_pick_options(CLI::App& app, PickCommand& command) {
    add_scene(app, command.scene);
    add_value(app, "--resolution", "W,H", "Size of the image that the pixels belong to",
              [&command](const std::string& text) { command.size = size_of(text); });
    add_values(app, "--pixel", "ROW,COL",
               "A pixel, row 0 being the top one; may be repeated. -: read lines ROW COL from "
               "standard input",
               [&command](const std::string& text) {
                   if (text == "-") return read_stream(StreamOf::pixels, command);
                   command.pixels.push_back(pixel_of(text));
               });
    add_values(app, "--ray", "OX,OY,OZ,DX,DY,DZ",
               "A ray by origin and direction, in the file's coordinates; the direction's length "
               "doesn't matter (it is printed with length 1, and t is a distance). -: read lines "
               "from standard input",
               [&command](const std::string& text) {
                   if (text == "-") return read_stream(StreamOf::rays, command);
                   command.rays.push_back(ray_of(text));
               });
    app.add_flag("--all", command.all, "Every hit along the ray, nearest first, as \"hits\"");
    add_camera(app, command.camera);
    app.footer(
        "Prints one JSON object a line. In a stream, a line that can't be answered gets one "
        "with \"error\", and the exit code is 2 at the end.");
}

void finish_pick(const PickCommand& command) {
    const bool wants_pixels = !command.pixels.empty() || command.stream == StreamOf::pixels;
    if (!wants_pixels && command.rays.empty() && !command.stream) {
        throw CLI::ValidationError(
            "nothing to pick: give --pixel=ROW,COL or --ray=OX,OY,OZ,DX,DY,DZ");
    }
    if (wants_pixels && !command.size) {
        throw CLI::ValidationError("--pixel", "needs --resolution=W,H, the image it belongs to");
    }
    for (const Pixel& pixel : command.pixels)
        check_inside(pixel, *command.size);
}

}  // namespace raypick
