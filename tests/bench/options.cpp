#include "tests/bench/options.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace raypick::bench {

namespace {

[[noreturn]] void refuse(const std::string& word) {
    throw std::invalid_argument("raypick_bench: can't make sense of " + word + "\n" + usage());
}

// What follows "--name="; nothing if `word` is another option.
std::optional<std::string> value_of(const std::string& word, const std::string& name) {
    const std::string start = "--" + name + "=";
    if (word.rfind(start, 0) != 0) return std::nullopt;
    return word.substr(start.size());
}

// Positive integers between commas.
std::vector<int> numbers(const std::string& word, std::string_view text) {
    std::vector<int> result;
    while (!text.empty()) {
        const std::string_view item = text.substr(0, text.find(','));
        int number = 0;
        const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), number);
        if (error != std::errc{} || end != item.data() + item.size() || number < 1) refuse(word);
        result.push_back(number);
        text.remove_prefix(std::min(text.size(), item.size() + 1));
    }
    if (result.empty()) refuse(word);
    return result;
}

// Small enough for CI: under 30 s on two busy cores.
void shrink(Options& options) {
    options.smoke = true;
    options.rounds = 1;
    options.size = {90, 160};
}

ImageSize size_of(const std::string& word, const std::string& text) {
    const std::vector<int> sides = numbers(word, text);
    if (sides.size() != 2) refuse(word);
    return {sides[1], sides[0]};
}

void read_word(Options& options, const std::string& word) {
    if (const auto only = value_of(word, "only")) {
        options.only = *only;
    } else if (const auto threads = value_of(word, "threads")) {
        options.threads = numbers(word, *threads);
    } else if (const auto rounds = value_of(word, "rounds")) {
        options.rounds = numbers(word, *rounds).front();
    } else if (const auto json = value_of(word, "json")) {
        options.json = *json;
    } else if (const auto models = value_of(word, "models")) {
        options.models = *models;
    } else if (const auto program = value_of(word, "program")) {
        options.program = *program;
    } else if (const auto size = value_of(word, "size")) {
        options.size = size_of(word, *size);
    } else if (const auto isa = value_of(word, "isa")) {
        if (*isa != "avx2") refuse(word);
        options.isa = *isa;
    } else {
        refuse(word);
    }
}

}  // namespace

Options parse_options(const std::vector<std::string>& words) {
    Options options;
    if (std::find(words.begin(), words.end(), "--smoke") != words.end()) shrink(options);
    for (const std::string& word : words) {
        if (word != "--smoke") read_word(options, word);
    }
    return options;
}

std::string usage() {
    return "raypick_bench [--smoke] [--only=SUBSTRING] [--threads=1,2] [--rounds=5]\n"
           "              [--size=1920,1080] [--isa=avx2] [--json=FILE] [--models=FOLDER]\n"
           "              [--program=FILE]\n"
           "Rows are named group/scene/what, as in kernels/bunny/primary.\n";
}

}  // namespace raypick::bench
