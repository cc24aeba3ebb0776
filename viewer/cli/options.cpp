#include "viewer/cli/options.h"

#include "viewer/cli/exit_code.h"
#include "viewer/cli/numbers.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace raypick {
namespace {

constexpr std::array<const char*, 4> kCommandNames = {"view", "pick", "render", "info"};

// Sides of an image; also what a 16-bit texture coordinate and a PNG reader can be expected to
// take.
constexpr int kMaxSide = 65535;

[[noreturn]] void refuse(const std::string& option, const std::string& expected,
                         const std::string& given) {
    throw CLI::ValidationError(option, fmt::format("expected {}, got '{}'", expected, given));
}

double number_in(const std::string& option, const std::string& text, double low, double high,
                 const std::string& expected) {
    const std::optional<double> number = parse_double(text);
    if (!number || *number < low || *number > high) refuse(option, expected, text);
    return *number;
}

int whole_number_in(const std::string& option, const std::string& text, int low, int high) {
    const std::optional<int> number = parse_int(text);
    if (!number || *number < low || *number > high) {
        refuse(option, fmt::format("a whole number from {} to {}", low, high), text);
    }
    return *number;
}

// Of places that a person may name: rays are traced in float, which ends at 3.4e38.
constexpr double kMostCoordinate = 1e30;

template <std::size_t N>
bool all_moderate(const std::array<double, N>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](double number) { return std::abs(number) <= kMostCoordinate; });
}

glm::dvec3 point_of(const std::string& option, const std::string& text) {
    const auto xyz = parse_doubles<3>(text, Separator::comma);
    if (!xyz || !all_moderate(*xyz)) refuse(option, "X,Y,Z (numbers up to 1e30)", text);
    return {(*xyz)[0], (*xyz)[1], (*xyz)[2]};
}

ImageSize size_of(const std::string& text) {
    const auto wh = parse_ints<2>(text, Separator::comma);
    const auto allowed = [](int side) { return side >= 1 && side <= kMaxSide; };
    if (!wh || !allowed((*wh)[0]) || !allowed((*wh)[1])) {
        refuse("--resolution", fmt::format("W,H (each from 1 to {})", kMaxSide), text);
    }
    return {(*wh)[1], (*wh)[0]};
}

Pixel pixel_of(const std::string& text) {
    const auto row_col = parse_ints<2>(text, Separator::comma);
    if (!row_col) refuse("--pixel", "ROW,COL (whole numbers) or -", text);
    return {(*row_col)[0], (*row_col)[1]};
}

FileRay ray_of(const std::string& text) {
    const auto numbers = parse_doubles<6>(text, Separator::comma);
    if (!numbers) refuse("--ray", "OX,OY,OZ,DX,DY,DZ or -", text);
    const std::optional<FileRay> ray = file_ray(*numbers);
    if (!ray) refuse("--ray", "numbers up to 1e30 and a direction other than 0,0,0", text);
    return *ray;
}

// An option with a value that is understood by `read(text)`; shown as --NAME=TYPE.
template <typename Read>
CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type,
                       const std::string& description, const Read& read) {
    return app.add_option_function<std::string>(name, read, description)->type_name(type);
}

// The same for an option that may be given several times, with one value each time.
template <typename Read>
void add_values(CLI::App& app, const std::string& name, const std::string& type,
                const std::string& description, const Read& read) {
    const auto read_all = [read](const std::vector<std::string>& texts) {
        for (const std::string& text : texts)
            read(text);
    };
    app.add_option_function<std::vector<std::string>>(name, read_all, description)
        ->type_name(type)
        ->allow_extra_args(false);
}

void add_camera(CLI::App& app, CameraOverride& camera) {
    const auto add_point = [&](const std::string& name, const std::string& description,
                               std::optional<glm::dvec3>& point) {
        add_value(app, name, "X,Y,Z", description,
                  [name, &point](const std::string& text) { point = point_of(name, text); });
    };
    add_point("--eye", "Where the camera stands, in the file's coordinates", camera.eye);
    add_point("--look-at", "The point it looks at", camera.at);
    add_value(app, "--up", "X,Y,Z", "The direction that is up in the image",
              [&camera](const std::string& text) {
                  camera.up = point_of("--up", text);
                  if (*camera.up == glm::dvec3(0.0)) refuse("--up", "a direction", text);
              });
    add_value(app, "--fovy", "DEG", "Vertical field of view, above 0 and below 180 degrees",
              [&camera](const std::string& text) {
                  camera.fovy =
                      number_in("--fovy", text, std::nextafter(0.0, 1.0),
                                std::nextafter(180.0, 0.0), "an angle above 0 and below 180");
              });
}

void add_crease(CLI::App& app, double& crease_degrees) {
    add_value(
        app, "--crease", "DEG",
        "Meshes without normals look smooth where faces meet at less than this angle; 0: flat "
        "[30]",
        [&crease_degrees](const std::string& text) {
            crease_degrees = number_in("--crease", text, 0.0, 180.0, "an angle from 0 to 180");
        });
}

void add_resolution(CLI::App& app, const std::string& description, ImageSize& size) {
    add_value(app, "--resolution", "W,H", description,
              [&size](const std::string& text) { size = size_of(text); });
}

void add_depth(CLI::App& app, int& depth) {
    add_value(
        app, "--depth", "N", "Longest chain of rays, the eye's ray being the first [5]",
        [&depth](const std::string& text) { depth = whole_number_in("--depth", text, 1, 64); });
}

void add_threads(CLI::App& app, int& threads) {
    add_value(app, "--threads", "N", "Threads to trace with; 0: one a core [0]",
              [&threads](const std::string& text) {
                  threads = whole_number_in("--threads", text, 0, 1024);
              });
}

void add_off_switch(CLI::App& app, const std::string& name, const std::string& description,
                    bool& setting) {
    app.add_flag_callback(
        name, [&setting] { setting = false; }, description);
}

void add_scene(CLI::App& app, SceneOptions& scene) {
    app.add_option("FILE", scene.file, "A scene or a model: JSON, OBJ, glTF, GLB, PLY, STL")
        ->required()
        ->type_name("");
    add_crease(app, scene.crease_degrees);
}

// Text in lines of at most `width` characters, broken at blanks.
std::string wrapped(const std::string& text, std::size_t width) {
    std::istringstream words(text);
    std::string result;
    std::size_t column = 0;
    for (std::string word; words >> word;) {
        const bool fits = column + 1 + word.size() <= width;
        if (!result.empty()) result += fits ? ' ' : '\n';
        column = fits && !result.empty() ? column + 1 + word.size() : word.size();
        result += word;
    }
    return result;
}

// Prints options as --NAME=TYPE, and everything within 80 columns.
class HelpFormatter : public CLI::Formatter {
public:
    HelpFormatter() {
        column_width(kNameColumns);
        label("SUBCOMMAND", "COMMAND");
        label("Positionals", "Arguments");
    }

    std::string make_option_opts(const CLI::Option* option) const override {
        const std::string type = option->get_type_name();
        if (option->get_positional() || type.empty()) return "";
        return "=" + type;
    }

    std::string make_option_desc(const CLI::Option* option) const override {
        return wrapped(option->get_description(), kLineColumns - kNameColumns);
    }

    std::string make_footer(const CLI::App* app) const override {
        const std::string footer = app->get_footer();
        return footer.empty() ? "" : wrapped(footer, kLineColumns) + '\n';
    }

private:
    static constexpr std::size_t kLineColumns = 80;
    static constexpr std::size_t kNameColumns = 30;
};

// The one table of options.
class Table {
public:
    Table()
        : app_("Shows a 3D scene, says what lies under a pixel, ray-traces the view.", "raypick") {
        app_.formatter(std::make_shared<HelpFormatter>());
        app_.set_help_flag("-h,--help", "Print this help and end");
        app_.set_version_flag("--version", "raypick " RAYPICK_VERSION, "Print the version and end");
        app_.add_flag("--verbose", verbose_,
                      "Say on standard error what is done and how long it takes");
        app_.require_subcommand(1);
        add_view();
        add_pick();
        add_render();
        add_info();
        // After the commands, which would inherit it.
        app_.footer(
            "`raypick FILE` is `raypick view FILE`. `raypick COMMAND --help` lists a "
            "command's options. Exit codes: 0 done, 1 failed, 2 wrong usage, 77 no OpenGL, "
            "130 or 143 interrupted.");
    }

    CLI::App& app() { return app_; }

    // What was asked for, once parsed. Throws CLI::ValidationError.
    Command command() {
        if (app_.got_subcommand("view")) return view_;
        if (app_.got_subcommand("pick")) return finished_pick();
        if (app_.got_subcommand("render")) return finished_render();
        info_.scene.verbose = verbose_;
        return info_;
    }

private:
    CLI::App& add_command(const std::string& name, const std::string& description) {
        CLI::App& app = *app_.add_subcommand(name, description);
        app.fallthrough();  // --verbose after the command's name
        app.group("Commands");
        return app;
    }

    void add_view();
    void add_pick();
    void add_render();
    void add_info();

    PickCommand finished_pick();
    RenderCommand finished_render();

    CLI::App app_;
    bool verbose_ = false;
    ViewCommand view_;
    PickCommand pick_;
    RenderCommand render_;
    InfoCommand info_;
};

void Table::add_view() {
    CLI::App& app = add_command("view", "Open a window: look, click, ray-trace (the default)");
    ViewOptions& options = view_.options;
    app.add_option("FILE", options.file, "What to open; without it the default scene")
        ->type_name("");
    add_resolution(app, "Size of the window [1280,720]", options.size);
    app.add_flag("--trace", options.trace, "Begin with the ray-traced preview");
    app.add_flag("--print-picks", options.print_picks,
                 "Print each click's pick as a line of JSON on standard output");
    add_value(app, "--ui-scale", "N", "Size of fonts and panels; 0: the monitor's own [0]",
              [&options](const std::string& text) {
                  options.ui_scale =
                      number_in("--ui-scale", text, 0.0, 8.0, "a number from 0 to 8");
              });
    add_depth(app, options.depth);
    add_camera(app, options.camera);
    add_crease(app, options.crease_degrees);
}

void Table::add_pick() {
    CLI::App& app = add_command("pick", "Say what lies under pixels or along rays, as JSON lines");
    add_scene(app, pick_.scene);
    add_value(app, "--resolution", "W,H", "Size of the image that the pixels belong to",
              [this](const std::string& text) { pick_.size = size_of(text); });
    const auto stream = [this](StreamOf what) {
        if (pick_.stream) throw CLI::ValidationError("standard input can be read only once");
        pick_.stream = what;
    };
    add_values(app, "--pixel", "ROW,COL",
               "A pixel, row 0 being the top one; may be repeated. -: read lines ROW COL from "
               "standard input",
               [this, stream](const std::string& text) {
                   if (text == "-") return stream(StreamOf::pixels);
                   pick_.pixels.push_back(pixel_of(text));
               });
    add_values(app, "--ray", "OX,OY,OZ,DX,DY,DZ",
               "A ray by origin and direction, in the file's coordinates; the direction's length "
               "doesn't matter (it is printed with length 1, and t is a distance). -: read lines "
               "from standard input",
               [this, stream](const std::string& text) {
                   if (text == "-") return stream(StreamOf::rays);
                   pick_.rays.push_back(ray_of(text));
               });
    app.add_flag("--all", pick_.all, "Every hit along the ray, nearest first, as \"hits\"");
    add_camera(app, pick_.camera);
    app.footer(
        "Prints one JSON object a line. In a stream, a line that can't be answered gets one "
        "with \"error\", and the exit code is 2 at the end.");
}

void Table::add_render() {
    CLI::App& app =
        add_command("render", "Write an image of the scene: traced, or drawn by OpenGL");
    add_scene(app, render_.scene);
    app.add_option(
           "--output", render_.output,
           "Where to: .png (sRGB), .exr (linear colour, depth, normals, ids), or - for PNG on "
           "standard output")
        ->required()
        ->type_name("FILE");
    add_resolution(app, "Size of the image [1280,720]", render_.size);
    app.add_flag("--raster", render_.raster, "Draw by OpenGL, off screen, instead of tracing");
    add_depth(app, render_.settings.depth);
    add_off_switch(app, "--no-shadows", "Leave out shadows", render_.settings.shadows);
    add_off_switch(app, "--no-reflections", "Leave out mirror images",
                   render_.settings.reflections);
    add_off_switch(app, "--no-refractions", "Leave out what is seen through glass",
                   render_.settings.refractions);
    add_threads(app, render_.settings.threads);
    add_value(app, "--stats", "json", "Print times, counts of rays and memory on standard output",
              [this](const std::string& text) {
                  if (text != "json") refuse("--stats", "json", text);
                  render_.json_stats = true;
              });
    add_camera(app, render_.camera);
}

void Table::add_info() {
    CLI::App& app = add_command("info", "Say what a file holds");
    add_scene(app, info_.scene);
    app.add_flag("--json", info_.json, "As one JSON object");
    app.add_flag("--objects", info_.objects, "List every object");
}

PickCommand Table::finished_pick() {
    const bool wants_pixels = !pick_.pixels.empty() || pick_.stream == StreamOf::pixels;
    if (!wants_pixels && pick_.rays.empty() && !pick_.stream) {
        throw CLI::ValidationError(
            "nothing to pick: give --pixel=ROW,COL or --ray=OX,OY,OZ,DX,DY,DZ");
    }
    if (wants_pixels && !pick_.size) {
        throw CLI::ValidationError("--pixel", "needs --resolution=W,H, the image it belongs to");
    }
    for (const Pixel& pixel : pick_.pixels) {
        if (pick_.size->contains(pixel)) continue;
        throw CLI::ValidationError(
            "--pixel",
            fmt::format("row {}, column {} is outside the image of {} rows and {} columns",
                        pixel.row, pixel.col, pick_.size->rows, pick_.size->cols));
    }
    pick_.scene.verbose = verbose_;
    return pick_;
}

RenderCommand Table::finished_render() {
    if (render_.output == "-" && render_.json_stats) {
        throw CLI::ValidationError("--stats=json and --output=- both want standard output");
    }
    render_.scene.verbose = verbose_;
    return render_;
}

bool is_command(const std::string& word) {
    return std::find(kCommandNames.begin(), kCommandNames.end(), word) != kCommandNames.end();
}

bool asks_about_program(const std::string& word) {
    return word == "--help" || word == "-h" || word == "--version";
}

// Names the command that is meant where none is named: the first word decides, --verbose aside.
// Returns the command's name, "" if the program itself is asked about.
std::string name_command(std::vector<std::string>& words) {
    const auto first = std::find_if(words.begin(), words.end(),
                                    [](const std::string& word) { return word != "--verbose"; });
    if (first != words.end() && asks_about_program(*first)) return "";
    if (first != words.end() && is_command(*first)) return *first;
    words.insert(words.begin(), "view");
    return "view";
}

std::string usage_message(const CLI::ParseError& error, const std::string& command) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    return fmt::format("{} (see raypick {}{}--help)", what, command, command.empty() ? "" : " ");
}

}  // namespace

std::optional<FileRay> file_ray(const std::array<double, 6>& numbers) {
    const glm::dvec3 origin(numbers[0], numbers[1], numbers[2]);
    const glm::dvec3 direction(numbers[3], numbers[4], numbers[5]);
    const glm::dvec3 sizes = glm::abs(direction);
    const double largest = std::max({sizes.x, sizes.y, sizes.z});
    if (!(largest > 0.0) || !all_moderate(numbers)) return std::nullopt;
    // First by the largest part, so that squares neither overflow nor vanish.
    return FileRay{origin, glm::normalize(direction / largest)};
}

std::optional<Command> parse_command_line(std::vector<std::string> words) {
    const std::string command = name_command(words);
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    Table table;
    try {
        table.app().parse(std::move(words));
        return table.command();
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
            table.app().exit(error);  // prints help or version
            return std::nullopt;
        }
        throw UsageError(usage_message(error, command));
    }
}

}  // namespace raypick
