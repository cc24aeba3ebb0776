#include "viewer/cli/help_formatter.h"

#include <sstream>

namespace raypick {
namespace {

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

}  // namespace

HelpFormatter::HelpFormatter() {
    column_width(kNameColumns);
    label("SUBCOMMAND", "COMMAND");
    label("Positionals", "Arguments");
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    const std::string type = option->get_type_name();
    if (option->get_positional() || type.empty()) return "";
    const bool value_may_be_missing = option->get_expected_min() == 0;
    return value_may_be_missing ? "[=" + type + "]" : "=" + type;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    return wrapped(option->get_description(), kLineColumns - kNameColumns);
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
    const std::string footer = app->get_footer();
    return footer.empty() ? "" : wrapped(footer, kLineColumns) + '\n';
}

}  // namespace raypick
