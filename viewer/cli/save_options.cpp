#include "viewer/cli/command_options.h"
#include "viewer/cli/option_values.h"
#include "viewer/cli/shared_options.h"

#include <algorithm>
#include <cctype>

namespace raypick {
namespace {

bool ends_in_json(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".json";
}

}  // namespace

void add_save_options(CLI::App& app, SaveCommand& command) {
    add_scene(app, command.scene);
    add_value(app, "--output", "FILE", "The scene file to write: its name ends in .json",
              [&command](const std::string& text) { command.output = text; })
        ->required();
}

void finish_save(const SaveCommand& command) {
    if (ends_in_json(command.output)) return;
    throw CLI::ValidationError("--output", "scenes are written as .json");
}

}  // namespace raypick
