#include "tracer/io/text_scanner.h"

#include "tracer/error.h"
#include "tracer/io/file_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

namespace raypick {

namespace {

// How Microsoft's printf spells what is no number: 1.#INF, -1.#IND, 1.#QNAN.
std::optional<double> parse_microsoft(std::string_view word) {
    const bool negative = word.substr(0, 1) == "-";
    if (negative) word.remove_prefix(1);
    if (word.substr(0, 3) != "1.#") return std::nullopt;
    const bool infinite = word.substr(3, 3) == "INF";
    const double value = infinite ? std::numeric_limits<double>::infinity()
                                  : std::numeric_limits<double>::quiet_NaN();
    return negative ? -value : value;
}

// What a well-formed number beyond double's range stands for: 0 with a negative exponent or,
// without any, where nothing but zeros stands before the point.
double beyond_double(std::string_view word) {
    const std::size_t exponent = word.find_first_of("eE");
    const bool small = exponent != std::string_view::npos
                           ? word.find('-', exponent) != std::string_view::npos
                           : word.find_first_of("123456789") > word.find('.');
    const double size = small ? 0.0 : std::numeric_limits<double>::infinity();
    return word.front() == '-' ? -size : size;
}

}  // namespace

std::optional<double> parse_number(std::string_view word) {
    const std::string_view whole = word;
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0.0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end) return parse_microsoft(whole);
    if (error == std::errc()) return value;
    // Too large or too small for a double: infinity or 0.
    if (error == std::errc::result_out_of_range) return beyond_double(word);
    return std::nullopt;
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t kLongest = 60;
    const bool longer = word.size() > kLongest;
    return '"' + clean_name(word.substr(0, kLongest)) + (longer ? "...\"" : "\"");
}

TextScanner::TextScanner(std::string file, std::string_view text, bool continuation,
                         std::size_t first_line)
    : file_(std::move(file)),
      begin_(text.data()),
      p_(text.data()),
      end_(text.data() + text.size()),
      last_word_(text.data()),
      continuation_(continuation),
      first_line_(first_line) {}

std::size_t TextScanner::continuation_length() const {
    if (end_ - p_ >= 2 && p_[1] == '\n') return 2;
    if (end_ - p_ >= 3 && p_[1] == '\r' && p_[2] == '\n') return 3;
    return 0;
}

std::string_view TextScanner::word_anywhere() {
    while (at_line_end() && p_ != end_)
        ++p_;
    return word();
}

std::string_view TextScanner::rest() {
    skip_blanks();
    last_word_ = p_;
    const void* newline = std::memchr(p_, '\n', static_cast<std::size_t>(end_ - p_));
    const char* stop = newline != nullptr ? static_cast<const char*>(newline) : end_;
    p_ = stop;
    while (stop != last_word_ && is_blank(stop[-1]))
        --stop;
    return {last_word_, static_cast<std::size_t>(stop - last_word_)};
}

void TextScanner::next_line() {
    const void* newline = std::memchr(p_, '\n', static_cast<std::size_t>(end_ - p_));
    p_ = newline != nullptr ? static_cast<const char*>(newline) + 1 : end_;
}

std::optional<double> TextScanner::try_number() {
    skip_blanks();
    last_word_ = p_;
    // The common spelling is parsed where it stands.
    double value = 0.0;
    const auto [stop, error] = std::from_chars(p_, end_, value);
    if (error == std::errc() && (stop == end_ || *stop == '\n' || is_blank(*stop))) {
        p_ = stop;
        return value;
    }
    const char* const before = p_;
    const std::optional<double> number = parse_number(word());
    if (!number) p_ = before;
    return number;
}

double TextScanner::number(std::string_view what) {
    if (const std::optional<double> value = try_number()) return *value;
    const std::string_view found = word();
    if (found.empty()) fail(fmt::format("{} is missing", what));
    fail(fmt::format("{}: {} is no number", what, in_quotes(found)));
}

void TextScanner::fail(const std::string& complaint) const {
    fail_at(static_cast<std::size_t>(last_word_ - begin_), complaint);
}

void TextScanner::fail_at(std::size_t offset, const std::string& complaint) const {
    throw FileError(file_, fmt::format("line {}: {}", line(offset), complaint));
}

std::string TextScanner::place(std::size_t offset, const std::string& complaint) const {
    return fmt::format("{}: line {}: {}", file_, line(offset), complaint);
}

std::string TextScanner::place(const std::string& complaint) const {
    return place(static_cast<std::size_t>(last_word_ - begin_), complaint);
}

std::size_t TextScanner::line(std::size_t offset) const {
    return first_line_ + static_cast<std::size_t>(std::count(begin_, begin_ + offset, '\n'));
}

}  // namespace raypick
