#include "viewer/cli/options.h"

#include "viewer/cli/command_options.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/help_formatter.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <memory>

namespace raypick {
namespace {

constexpr std::array<const char*, 5> kCommandNames = {"view", "pick", "render", "info", "save"};

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
        add_view_options(add_command("view", "Open a window: look, click, ray-trace (the default)"),
                         view_);
        add_pick_options(
            add_command("pick", "Say what lies under pixels or along rays, as JSON lines"), pick_);
        add_render_options(
            add_command("render", "Write an image of the scene: traced, or drawn by OpenGL"),
            render_);
        add_info_options(add_command("info", "Say what a file holds"), info_);
        add_save_options(
            add_command("save", "Write a scene, from whatever file, as one of our scene files"),
            save_);
        // After the commands, which would inherit it.
        app_.footer(
            "`raypick FILE` is `raypick view FILE`. `raypick COMMAND --help` lists a "
            "command's options. Exit codes: 0 done, 1 failed, 2 wrong usage, 77 no OpenGL, "
            "130 or 143 interrupted.");
    }

    CLI::App& app() { return app_; }

    // What was asked for, once parsed. Throws CLI::ValidationError.
    Command command() {
        for (SceneOptions* scene : {&pick_.scene, &render_.scene, &info_.scene, &save_.scene})
            scene->verbose = verbose_;
        if (app_.got_subcommand("view")) return view_;
        if (app_.got_subcommand("pick")) {
            finish_pick(pick_);
            return pick_;
        }
        if (app_.got_subcommand("render")) {
            finish_render(*app_.get_subcommand("render"), render_);
            return render_;
        }
        if (app_.got_subcommand("save")) {
            finish_save(save_);
            return save_;
        }
        return info_;
    }

private:
    CLI::App& add_command(const std::string& name, const std::string& description) {
        CLI::App& app = *app_.add_subcommand(name, description);
        app.fallthrough();  // --verbose after the command's name
        app.group("Commands");
        return app;
    }

    CLI::App app_;
    bool verbose_ = false;
    ViewCommand view_;
    PickCommand pick_;
    RenderCommand render_;
    InfoCommand info_;
    SaveCommand save_;
};

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
