#include "picking/json.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace raypick {
namespace {

template <typename Number>
void append_number(std::string& out, Number value) {
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("{}"), value);
}

template <typename Vector>
void append_vector(std::string& out, const Vector& value) {
    out += '[';
    for (int axis = 0; axis < Vector::length(); ++axis) {
        if (axis > 0) out += ',';
        append_json(out, value[axis]);
    }
    out += ']';
}

bool is_continuation(unsigned char byte) {
    return (byte & 0xc0u) == 0x80u;
}

// Bytes of the UTF-8 sequence that `text` begins with; 0 if it is not a valid one (Unicode 15,
// table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF).
std::size_t utf8_length(std::string_view text) {
    const auto byte = [text](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i])
                               : static_cast<unsigned char>(0);
    };
    const unsigned first = byte(0);
    const unsigned second = byte(1);
    if (first < 0x80) return 1;
    if (first < 0xc2 || first > 0xf4 || !is_continuation(byte(1))) return 0;
    if (first < 0xe0) return 2;
    if (!is_continuation(byte(2))) return 0;
    if (first < 0xf0) {
        const bool overlong = first == 0xe0 && second < 0xa0;
        const bool surrogate = first == 0xed && second >= 0xa0;
        return overlong || surrogate ? 0 : 3;
    }
    if (!is_continuation(byte(3))) return 0;
    const bool overlong = first == 0xf0 && second < 0x90;
    const bool too_large = first == 0xf4 && second >= 0x90;
    return overlong || too_large ? 0 : 4;
}

void append_escaped(std::string& out, char c) {
    switch (c) {
        case '"':
            out += "\\\"";
            break;
        case '\\':
            out += "\\\\";
            break;
        case '\n':
            out += "\\n";
            break;
        case '\r':
            out += "\\r";
            break;
        case '\t':
            out += "\\t";
            break;
        default:
            fmt::format_to(std::back_inserter(out), FMT_COMPILE("\\u{:04x}"), int{c});
    }
}

bool needs_escape(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\';
}

}  // namespace

void append_json(std::string& out, float value) {
    if (std::isfinite(value)) {
        append_number(out, value);
    } else {
        out += "null";
    }
}

void append_json(std::string& out, double value) {
    if (std::isfinite(value)) {
        append_number(out, value);
    } else {
        out += "null";
    }
}

void append_json(std::string& out, std::int64_t value) {
    append_number(out, value);
}

void append_json(std::string& out, const glm::vec2& value) {
    append_vector(out, value);
}

void append_json(std::string& out, const glm::vec3& value) {
    append_vector(out, value);
}

void append_json(std::string& out, const glm::dvec3& value) {
    append_vector(out, value);
}

void append_json(std::string& out, std::string_view text) {
    out += '"';
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0) {
            out += "\xef\xbf\xbd";
        } else if (needs_escape(text[0])) {
            append_escaped(out, text[0]);
        } else {
            out += text.substr(0, length);
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    out += '"';
}

}  // namespace raypick
