// Values of options: from the text behind the "=" to what it means, or a complaint that names the
// option (CLI::ValidationError).
#pragma once

#include "tracer/geometry/pixel.h"
#include "viewer/cli/options.h"

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

[[noreturn]] void refuse(const std::string& option, const std::string& expected,
                         const std::string& given);

double number_in(const std::string& option, const std::string& text, double low, double high,
                 const std::string& expected);
int whole_number_in(const std::string& option, const std::string& text, int low, int high);
// From 0 on, up to 64 bits.
std::uint64_t natural_number(const std::string& option, const std::string& text);
// X,Y,Z.
glm::dvec3 point_of(const std::string& option, const std::string& text);
// W,H.
ImageSize size_of(const std::string& text);
// ROW,COL.
Pixel pixel_of(const std::string& text);
// OX,OY,OZ,DX,DY,DZ.
FileRay ray_of(const std::string& text);

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

// An option whose value is one of some words; shown as --NAME=A|B|C.
template <typename T>
void add_choice(CLI::App& app, const std::string& name, const std::string& description,
                const std::vector<std::pair<std::string, T>>& choices, T& setting) {
    std::string words;
    for (const auto& choice : choices)
        words += (words.empty() ? "" : "|") + choice.first;
    add_value(app, name, words, description,
              [name, choices, words, &setting](const std::string& text) {
                  for (const auto& choice : choices) {
                      if (choice.first != text) continue;
                      setting = choice.second;
                      return;
                  }
                  refuse(name, words, text);
              });
}

void add_off_switch(CLI::App& app, const std::string& name, const std::string& description,
                    bool& setting);

}  // namespace raypick
