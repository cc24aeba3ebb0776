// JSON read with care: every value knows where it stands, and what is wrong is said there.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raypick {

using Json = nlohmann::json;

// JSON with comments. Throws FileError with line and column on a syntax error, with line and JSON
// path if an object has the same key twice or the nesting is absurd.
Json parse_json(const std::string& file, std::string_view text);

// Which numbers are welcome, and how to say so.
struct NumberRule {
    double min = 0.0;
    double max = 0.0;
    bool ends_allowed = true;  // min and max themselves
    std::string_view words;    // "must be ...": a positive number
};

// A file's JSON as a whole.
struct JsonFile {
    std::string name;
    Json root;
    std::string_view text;  // for lines in messages; "" if a person can't look there
};

// A reference to a value of a file's JSON; the file must outlive it. All readers throw FileError:
// "FILE: line 7: /objects/3/radius (of "ball"): must be a positive number, not "big"".
class JsonValue {
public:
    explicit JsonValue(const JsonFile& file);
    // Of a file whose messages have neither lines nor names; both must outlive this.
    JsonValue(const std::string& file, const Json& json, std::string path = "");

    [[noreturn]] void fail(std::string_view complaint) const;
    // "line 7: /objects/3/radius (of "ball")"
    [[nodiscard]] std::string place() const;
    // Complains that the value is not what `expected` says ("a number").
    [[noreturn]] void refuse(std::string_view expected) const;

    [[nodiscard]] bool is_object() const { return json_->is_object(); }
    [[nodiscard]] bool is_array() const { return json_->is_array(); }
    [[nodiscard]] bool is_number() const { return json_->is_number(); }
    [[nodiscard]] bool is_string() const { return json_->is_string(); }

    [[nodiscard]] bool equals(const Json& other) const { return *json_ == other; }

    // Fails unless this is an object with no other keys; `what` names it: "a camera".
    void only_keys(std::string_view what, std::span<const std::string_view> keys) const;
    [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
    [[nodiscard]] JsonValue need(std::string_view key) const;
    [[nodiscard]] std::vector<std::pair<std::string, JsonValue>> members() const;

    [[nodiscard]] std::vector<JsonValue> elements() const;
    // Elements of an array of just this length; `expected` says what it should be.
    [[nodiscard]] std::vector<JsonValue> elements(std::size_t count,
                                                  std::string_view expected) const;

    // Not empty.
    [[nodiscard]] const std::string& text() const;
    [[nodiscard]] const std::string& text_or_empty() const;
    [[nodiscard]] bool truth() const;  // true or false
    // One of a few words.
    [[nodiscard]] std::string one_of(std::span<const std::string_view> words) const;
    [[nodiscard]] double number(const NumberRule& rule) const;
    // With the rule's words for what is no whole number, too.
    [[nodiscard]] std::int64_t whole_number(const NumberRule& rule) const;

private:
    JsonValue(const JsonFile* whole, const std::string* file, const Json* json, std::string path);

    const JsonFile* whole_ = nullptr;  // for lines and names in messages
    const std::string* file_;
    const Json* json_;
    std::string path_;
};

// `; did you mean "radius"?` if one of the known words is close to this one, else "".
std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);
// "a", "b" or "c"
std::string quoted_list(std::span<const std::string_view> words, std::string_view last_joint);

}  // namespace raypick
