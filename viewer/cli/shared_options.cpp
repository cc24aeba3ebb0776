#include "viewer/cli/shared_options.h"

#include "viewer/cli/numbers.h"
#include "viewer/cli/option_values.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace raypick {
namespace {

void add_point(CLI::App& app, const std::string& name, const std::string& description,
               std::optional<glm::dvec3>& point) {
    add_value(app, name, "X,Y,Z", description,
              [name, &point](const std::string& text) { point = point_of(name, text); });
}

void read_orthographic(const std::string& text, CameraOverride& camera) {
    camera.projection = Projection::orthographic;
    if (text == "true") return;  // what CLI11 makes of a missing value
    const std::optional<double> height = parse_double(text);
    if (!height || !(*height > 0.0) || *height > 1e30) {
        // CLI11 names the option itself here.
        throw CLI::ValidationError(
            fmt::format("expected a height above 0 and up to 1e30, got '{}'", text));
    }
    camera.height = *height;
}

}  // namespace

void add_scene(CLI::App& app, SceneOptions& scene) {
    app.add_option("FILE", scene.file, "A scene or a model: JSON, NFF, OBJ, glTF, GLB, PLY, STL")
        ->required()
        ->type_name("");
    add_crease(app, scene.crease_degrees);
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

void add_camera(CLI::App& app, CameraOverride& camera) {
    add_point(app, "--eye", "Where the camera stands, in the file's coordinates", camera.eye);
    add_point(app, "--look-at", "The point it looks at", camera.at);
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
    app.add_flag("--orthographic")
        ->description(
            "Parallel rays; the image shows this height of the scene, without it what keeps the "
            "size of what is looked at. Without --eye nothing of the scene is behind the camera")
        ->type_name("HEIGHT")
        ->each([&camera](const std::string& text) { read_orthographic(text, camera); });
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

}  // namespace raypick
