// Numbers as people write them on command lines and in pipes: the whole text must be the number.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace raypick {

// Nothing unless all of `text` is one finite number (no blanks, no hexadecimal, no "inf").
std::optional<double> parse_double(std::string_view text);
// Nothing unless all of `text` is one whole number that fits.
std::optional<int> parse_int(std::string_view text);

enum class Separator {
    comma,   // exactly one between two fields
    blanks,  // any number of blanks and tabs, also around the text
};

// Hands out the fields of a text one after the other, then nothing.
class Fields {
public:
    Fields(std::string_view text, Separator separator) : rest_(text), separator_(separator) {}

    std::optional<std::string_view> next();

private:
    std::string_view rest_;
    Separator separator_;
    bool ended_ = false;
};

// Nothing unless `text` is exactly N numbers.
template <std::size_t N, typename Parse>
auto parse_fields(std::string_view text, Separator separator, const Parse& parse) {
    std::optional<std::array<typename decltype(parse(text))::value_type, N>> numbers;
    numbers.emplace();
    Fields fields(text, separator);
    for (auto& number : *numbers) {
        const std::optional<std::string_view> field = fields.next();
        const auto parsed = field ? parse(*field) : std::nullopt;
        if (!parsed) return decltype(numbers)();
        number = *parsed;
    }
    if (fields.next()) numbers.reset();
    return numbers;
}

template <std::size_t N>
std::optional<std::array<double, N>> parse_doubles(std::string_view text, Separator separator) {
    return parse_fields<N>(text, separator, parse_double);
}

template <std::size_t N>
std::optional<std::array<int, N>> parse_ints(std::string_view text, Separator separator) {
    return parse_fields<N>(text, separator, parse_int);
}

}  // namespace raypick
