#include "tracer/io/json_value.h"

#include "tracer/error.h"
#include "tracer/io/json_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

namespace raypick {

namespace {

// Far beyond what any of our files needs; keeps hostile ones from eating the memory.
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxShown = 120;  // bytes of the file that a message may quote

// Cuts long text at a character's beginning.
std::string shortened(std::string text, std::size_t max) {
    if (text.size() <= max) return text;
    while (max > 0 && (static_cast<unsigned char>(text[max]) & 0xc0u) == 0x80u)
        --max;
    return text.substr(0, max) + "...";
}

// A key as a JSON pointer spells it (RFC 6901).
std::string escaped(std::string_view key) {
    std::string result;
    for (const char c : key) {
        if (c == '~') {
            result += "~0";
        } else if (c == '/') {
            result += "~1";
        } else {
            result += c;
        }
    }
    return result;
}

std::string shown_path(const std::string& path) {
    return path.empty() ? "/" : path;
}

// "line 3, column 5" of a byte; columns count characters.
std::string place(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    const auto column =
        1 + std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_begin), before.end(),
                          [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; });
    return fmt::format("line {}, column {}", line, column);
}

// A character as a message shows it.
std::string shown_character(std::string_view text, std::size_t byte) {
    if (byte >= text.size()) return "end of the file";
    const char c = text[byte];
    return c > ' ' && c <= '~' ? fmt::format("'{}'", c) : "character";
}

void replace(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
}

// The parser's complaint for a person. It says "[json...] parse error at line 1, column 2: syntax
// error while parsing value - invalid literal; last read: '...'; expected string literal".
std::string bare_complaint(std::string_view what, std::string_view text, std::size_t byte) {
    if (const std::size_t id = what.find("] "); id != std::string_view::npos) {
        what.remove_prefix(id + 2);
    }
    if (what.rfind("parse error at ", 0) == 0) {
        what.remove_prefix(std::min(what.size(), what.find(" - ") + 3));
    }
    std::string complaint(what);
    if (const std::size_t read = complaint.find("; last read: '"); read != std::string::npos) {
        const std::size_t expected = complaint.rfind("; expected ");
        const bool goes_on = expected != std::string::npos && expected > read;
        complaint.erase(read, goes_on ? expected - read : std::string::npos);
    }
    replace(complaint, "invalid literal", "unexpected " + shown_character(text, byte));
    replace(complaint, "end of input", "end of the file");
    replace(complaint, "string literal", "text in quotes");
    replace(complaint, "or a literal", "a text, a number, true, false or null");
    return shortened(std::move(complaint), kMaxShown);
}

// First pass over the text: finds what a DOM could not tell any more.
class SyntaxCheck : public nlohmann::json_sax<Json> {
public:
    explicit SyntaxCheck(std::string_view text) : text_(text) {}

    // Only after it stopped the parser: what is wrong, and where if that is a byte of the text.
    [[nodiscard]] const std::string& complaint() const { return complaint_; }
    [[nodiscard]] std::optional<std::size_t> byte() const { return byte_; }

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return open(false); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_array() override { return close(); }

    bool key(string_t& key) override {
        Level& level = levels_.back();
        level.key = key;
        level.at_value = true;
        if (level.keys.insert(key).second) return true;
        const std::string place = path();
        complaint_ = fmt::format("line {}: {}: the key \"{}\" stands there twice",
                                 json_line(text_, place + '/' + escaped(key)), shown_path(place),
                                 shortened(key, kMaxShown));
        return false;
    }

    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::detail::exception& error) override {
        byte_ = position > 0 ? position - 1 : 0;
        complaint_ = bare_complaint(error.what(), text_, *byte_);
        const std::string place = path_inside();
        if (!place.empty()) complaint_ += "; in " + shortened(place, kMaxShown);
        return false;
    }

private:
    struct Level {
        bool is_array = false;
        std::size_t index = 0;  // elements that have ended
        std::string key;
        bool at_value = false;  // of that key
        std::unordered_set<std::string> keys;
    };

    bool value() {
        if (!levels_.empty()) {
            ++levels_.back().index;
            levels_.back().at_value = false;
        }
        return true;
    }

    bool open(bool is_array) {
        if (levels_.size() == kMaxDepth) {
            complaint_ =
                fmt::format("line {}: {}: nested deeper than {} levels", json_line(text_, path()),
                            shortened(path(), kMaxShown), kMaxDepth);
            return false;
        }
        levels_.push_back({is_array, 0, {}, false, {}});
        return true;
    }

    bool close() {
        levels_.pop_back();
        return value();
    }

    // Of the innermost value that is open.
    [[nodiscard]] std::string path() const {
        std::string path;
        for (std::size_t i = 0; i + 1 < levels_.size(); ++i) {
            path += '/' + step(levels_[i]);
        }
        return path;
    }

    // Of the member or element that is being read in it.
    [[nodiscard]] std::string path_inside() const {
        if (levels_.empty()) return "";
        const bool inside = levels_.back().is_array || levels_.back().at_value;
        return inside ? path() + '/' + step(levels_.back()) : path();
    }

    static std::string step(const Level& level) {
        return level.is_array ? std::to_string(level.index) : escaped(level.key);
    }

    std::string_view text_;
    std::vector<Level> levels_;
    std::string complaint_;
    std::optional<std::size_t> byte_;
};

// A value as a message shows it.
std::string shown(const Json& json) {
    if (json.is_object()) return "an object";
    if (json.is_array()) return fmt::format("an array of {}", json.size());
    return shortened(json.dump(), kMaxShown);
}

// The "name" of the innermost value that has one and lies on a JSON pointer's way; "" if none does.
std::string name_on_the_way(const Json& root, const std::string& pointer) {
    for (std::string way = pointer; !way.empty(); way.erase(way.rfind('/'))) {
        const Json& value = root.at(Json::json_pointer(way));
        if (!value.is_object()) continue;
        const auto name = value.find("name");
        if (name != value.end() && name->is_string()) {
            return shortened(name->get<std::string>(), kMaxShown);
        }
    }
    return "";
}

// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

Json parse_json(const std::string& file, std::string_view text) {
    SyntaxCheck check(text);
    constexpr bool kStrict = true;
    constexpr bool kComments = true;
    constexpr bool kExceptions = true;
    if (!Json::sax_parse(text.begin(), text.end(), &check, nlohmann::detail::input_format_t::json,
                         kStrict, kComments)) {
        const std::optional<std::size_t> byte = check.byte();
        throw FileError(file,
                        byte ? place(text, *byte) + ": " + check.complaint() : check.complaint());
    }
    return Json::parse(text.begin(), text.end(), nullptr, kExceptions, kComments);
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> known) {
    constexpr std::size_t kLongest = 40;
    if (word.size() > kLongest) return "";
    std::string_view best;
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string_view candidate : known) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best.empty() ? "" : fmt::format("; did you mean \"{}\"?", best);
}

std::string quoted_list(std::span<const std::string_view> words, std::string_view last_joint) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) list += i + 1 == words.size() ? fmt::format(" {} ", last_joint) : ", ";
        list += fmt::format("\"{}\"", words[i]);
    }
    return list;
}

JsonValue::JsonValue(const JsonFile& file) : JsonValue(&file, &file.name, &file.root, "") {}

JsonValue::JsonValue(const std::string& file, const Json& json, std::string path)
    : JsonValue(nullptr, &file, &json, std::move(path)) {}

JsonValue::JsonValue(const JsonFile* whole, const std::string* file, const Json* json,
                     std::string path)
    : whole_(whole), file_(file), json_(json), path_(std::move(path)) {}

std::string JsonValue::place() const {
    std::string path = shown_path(path_);
    if (whole_ == nullptr || whole_->text.empty()) return path;
    const std::string name = name_on_the_way(whole_->root, path_);
    return fmt::format("line {}: {}{}", json_line(whole_->text, path_), path,
                       name.empty() ? "" : fmt::format(" (of \"{}\")", name));
}

void JsonValue::fail(std::string_view complaint) const {
    throw FileError(*file_, fmt::format("{}: {}", place(), complaint));
}

void JsonValue::refuse(std::string_view expected) const {
    fail(fmt::format("must be {}, not {}", expected, shown(*json_)));
}

void JsonValue::only_keys(std::string_view what, std::span<const std::string_view> keys) const {
    if (!is_object()) refuse(fmt::format("{} (an object)", what));
    for (const auto& member : json_->items()) {
        if (std::find(keys.begin(), keys.end(), member.key()) != keys.end()) continue;
        const std::string guess = did_you_mean(member.key(), keys);
        const std::string hint =
            guess.empty() ? fmt::format("; {} has {}", what, quoted_list(keys, "and")) : guess;
        need(member.key()).fail("unknown key" + hint);
    }
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
    const auto found = json_->find(key);
    if (found == json_->end()) return std::nullopt;
    return JsonValue(whole_, file_, &*found, path_ + '/' + escaped(key));
}

JsonValue JsonValue::need(std::string_view key) const {
    std::optional<JsonValue> value = find(key);
    if (!value) fail(fmt::format("\"{}\" is missing", key));
    return *std::move(value);
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
    if (!is_object()) refuse("an object");
    std::vector<std::pair<std::string, JsonValue>> members;
    for (const auto& member : json_->items()) {
        members.emplace_back(member.key(), need(member.key()));
    }
    return members;
}

std::vector<JsonValue> JsonValue::elements() const {
    if (!is_array()) refuse("an array");
    std::vector<JsonValue> elements;
    elements.reserve(json_->size());
    for (const Json& element : *json_) {
        elements.push_back(
            JsonValue(whole_, file_, &element, fmt::format("{}/{}", path_, elements.size())));
    }
    return elements;
}

std::vector<JsonValue> JsonValue::elements(std::size_t count, std::string_view expected) const {
    if (!is_array() || json_->size() != count) refuse(expected);
    return elements();
}

const std::string& JsonValue::text() const {
    const std::string& text = text_or_empty();
    if (text.empty()) fail("must not be empty");
    return text;
}

const std::string& JsonValue::text_or_empty() const {
    if (!is_string()) refuse("a text");
    return json_->get_ref<const std::string&>();
}

bool JsonValue::truth() const {
    if (!json_->is_boolean()) refuse("true or false");
    return json_->get<bool>();
}

std::string JsonValue::one_of(std::span<const std::string_view> words) const {
    const std::string expected = quoted_list(words, "or");
    if (!is_string()) refuse(expected);
    const auto& word = json_->get_ref<const std::string&>();
    if (std::find(words.begin(), words.end(), word) != words.end()) return word;
    fail(fmt::format("must be {}, not {}{}", expected, shown(*json_), did_you_mean(word, words)));
}

double JsonValue::number(const NumberRule& rule) const {
    if (!is_number()) refuse(rule.words);
    const double value = json_->get<double>();
    const bool inside = rule.ends_allowed ? value >= rule.min && value <= rule.max
                                          : value > rule.min && value < rule.max;
    if (!inside) refuse(rule.words);
    return value;
}

std::int64_t JsonValue::whole_number(const NumberRule& rule) const {
    const double value = number(rule);
    if (value != std::floor(value)) refuse(rule.words);
    return static_cast<std::int64_t>(value);
}

}  // namespace raypick
