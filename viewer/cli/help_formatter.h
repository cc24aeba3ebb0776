// How --help looks.
#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <string>

namespace raypick {

// Prints options as --NAME=TYPE, and everything within 80 columns.
class HelpFormatter : public CLI::Formatter {
public:
    HelpFormatter();

    std::string make_option_opts(const CLI::Option* option) const override;
    std::string make_option_desc(const CLI::Option* option) const override;
    std::string make_footer(const CLI::App* app) const override;

private:
    static constexpr std::size_t kLineColumns = 80;
    static constexpr std::size_t kNameColumns = 30;
};

}  // namespace raypick
