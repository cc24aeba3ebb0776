#include "tracer/io/json_place.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>

namespace raypick {

namespace {

// A JSON pointer's next component, unescaped; the pointer loses it.
std::string take_component(std::string_view& pointer) {
    pointer.remove_prefix(1);
    const std::string_view escaped = pointer.substr(0, pointer.find('/'));
    pointer.remove_prefix(escaped.size());
    std::string component;
    for (std::size_t i = 0; i < escaped.size(); ++i) {
        const bool is_escape = escaped[i] == '~' && i + 1 < escaped.size();
        if (is_escape) ++i;
        component += !is_escape ? escaped[i] : escaped[i] == '1' ? '/' : '~';
    }
    return component;
}

class Walker {
public:
    explicit Walker(std::string_view text) : text_(text) {}

    // From the beginning of a value to that of one of its members; false if it has none such.
    // `place` is then where the member begins, with its key.
    bool enter(const std::string& component, std::size_t& place) {
        skip_blanks();
        if (peek() == '{') return enter_member(component, place);
        if (peek() == '[') return enter_element(component, place);
        return false;
    }

    std::size_t value_begin() {
        skip_blanks();
        return at_;
    }

private:
    bool enter_member(const std::string& key, std::size_t& place) {
        ++at_;
        std::optional<std::size_t> found;
        for (skip_blanks(); peek() == '"'; skip_comma()) {
            const std::size_t key_begin = at_;
            const bool same = read_key() == key;
            skip_blanks();
            if (peek() == ':') ++at_;
            if (same) {
                place = key_begin;
                found = at_;
            }
            skip_value();
        }
        if (found) at_ = *found;
        return found.has_value();
    }

    bool enter_element(const std::string& number, std::size_t& place) {
        std::size_t index = 0;
        std::from_chars(number.data(), number.data() + number.size(), index);
        ++at_;
        skip_blanks();
        for (std::size_t i = 0; i < index && peek() != ']' && peek() != '\0'; ++i) {
            skip_value();
            skip_comma();
        }
        place = at_;
        return peek() != ']' && peek() != '\0';
    }

    [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void skip_comma() {
        skip_blanks();
        if (peek() == ',') ++at_;
        skip_blanks();
    }

    void skip_blanks() {
        while (at_ < text_.size()) {
            const std::string_view rest = text_.substr(at_);
            if (rest[0] == ' ' || rest[0] == '\t' || rest[0] == '\n' || rest[0] == '\r') {
                ++at_;
            } else if (rest.substr(0, 2) == "//") {
                at_ = std::min(text_.size(), text_.find('\n', at_));
            } else if (rest.substr(0, 2) == "/*") {
                const std::size_t end = text_.find("*/", at_ + 2);
                at_ = end == std::string_view::npos ? text_.size() : end + 2;
            } else {
                return;
            }
        }
    }

    void skip_string() {
        for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (text_[at_] == '\\') ++at_;
        }
        at_ = std::min(at_ + 1, text_.size());
    }

    std::string read_key() {
        const std::size_t begin = at_;
        skip_string();
        const nlohmann::json key =
            nlohmann::json::parse(text_.substr(begin, at_ - begin), nullptr, false);
        return key.is_string() ? key.get<std::string>() : "";
    }

    // Strings, brackets with all that is in them, or what goes on to the next separator.
    void skip_value() {
        std::size_t depth = 0;
        for (skip_blanks(); at_ < text_.size(); skip_blanks()) {
            const char c = peek();
            if (depth == 0 && (c == ',' || c == ']' || c == '}')) return;
            if (c == '"') {
                skip_string();
                continue;
            }
            if (c == '[' || c == '{') ++depth;
            if (c == ']' || c == '}') --depth;
            ++at_;
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

std::size_t json_line(std::string_view text, std::string_view pointer) {
    Walker walker(text);
    std::size_t place = walker.value_begin();
    while (!pointer.empty() && pointer[0] == '/' && walker.enter(take_component(pointer), place)) {
    }
    const std::string_view before = text.substr(0, place);
    return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

}  // namespace raypick
