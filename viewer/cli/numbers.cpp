#include "viewer/cli/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace raypick {
namespace {

template <typename Number>
std::optional<Number> parse_whole(std::string_view text) {
    Number number{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end) return std::nullopt;
    return number;
}

constexpr std::string_view kBlanks = " \t";

}  // namespace

std::optional<double> parse_double(std::string_view text) {
    const std::optional<double> number = parse_whole<double>(text);
    if (number && !std::isfinite(*number)) return std::nullopt;
    return number;
}

std::optional<int> parse_int(std::string_view text) {
    return parse_whole<int>(text);
}

std::optional<std::string_view> Fields::next() {
    if (separator_ == Separator::blanks) {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
        if (rest_.empty()) return std::nullopt;
    } else if (ended_) {
        return std::nullopt;
    }
    const std::size_t end =
        separator_ == Separator::blanks ? rest_.find_first_of(kBlanks) : rest_.find(',');
    const std::string_view field = rest_.substr(0, end);
    ended_ = end == std::string_view::npos;
    rest_.remove_prefix(ended_ ? rest_.size() : end + 1);
    return field;
}

}  // namespace raypick
