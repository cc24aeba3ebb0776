// The command line: what can be asked for, and its one table of options.
#pragma once

#include "tracer/geometry/pixel.h"
#include "tracer/scene/scene.h"
#include "tracer/shade/settings.h"
#include "viewer/app/view.h"

#include <glm/vec3.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace raypick {

// Which file to open, and how.
struct SceneOptions {
    std::filesystem::path file;
    double crease_degrees = 30.0;
    bool verbose = false;
};

struct ViewCommand {
    ViewOptions options;
};

// A ray in file coordinates.
struct FileRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};  // unit
};

// From OX OY OZ DX DY DZ with a direction of any length but 0. Nothing if it is 0 or a number is
// beyond 1e30.
std::optional<FileRay> file_ray(const std::array<double, 6>& numbers);

// What the lines of standard input hold.
enum class StreamOf { pixels, rays };

struct PickCommand {
    SceneOptions scene;
    CameraOverride camera;
    std::optional<ImageSize> size;  // always there if pixels are asked for
    std::vector<Pixel> pixels;      // inside `size`
    std::vector<FileRay> rays;
    std::optional<StreamOf> stream;  // answered last
    bool all = false;
};

struct RenderCommand {
    SceneOptions scene;
    CameraOverride camera;
    ImageSize size{720, 1280};
    std::string output;  // a file's name; "-": PNG on standard output
    bool raster = false;
    bool json_stats = false;
    RenderSettings settings;
};

struct InfoCommand {
    SceneOptions scene;
    bool json = false;
    bool objects = false;
};

struct SaveCommand {
    SceneOptions scene;
    std::filesystem::path output;  // ends in .json
};

using Command = std::variant<ViewCommand, PickCommand, RenderCommand, InfoCommand, SaveCommand>;

// Understands the words after the program's name. Nothing if they asked for help or the version,
// which then stands on standard output. Throws UsageError that names the option.
std::optional<Command> parse_command_line(std::vector<std::string> words);

}  // namespace raypick
