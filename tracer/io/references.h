// What a scene file calls by name or, where it stands in a list, by number.
#pragma once

#include "tracer/io/json_value.h"

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace raypick {

class References {
public:
    // `kind` for messages: "material".
    explicit References(std::string kind) : kind_(std::move(kind)) {}

    // An entry of a file's list, "" if it has no name, or of an object, which has no numbers.
    void add_listed(const std::string& name, std::uint32_t id);
    void add_named(const std::string& name, std::uint32_t id);

    // What `value` calls. Throws FileError if that is nothing, or several.
    [[nodiscard]] std::uint32_t read(const JsonValue& value) const;

private:
    [[nodiscard]] std::uint32_t by_name(const JsonValue& value) const;

    std::string kind_;
    std::vector<std::uint32_t> listed_;
    std::unordered_map<std::string, std::vector<std::uint32_t>> named_;
};

// Reads "materials" and its like: an object whose keys are the names, or a list of objects that may
// have a "name". read(value, name) returns the id of what it added.
template <typename Read>
void read_entries(const JsonValue& entries, References& references, const Read& read) {
    if (entries.is_array()) {
        for (const JsonValue& entry : entries.elements()) {
            if (!entry.is_object()) entry.refuse("an object");
            const std::optional<JsonValue> name = entry.find("name");
            const std::string text = name ? name->text_or_empty() : "";
            references.add_listed(text, read(entry, text));
        }
        return;
    }
    for (const auto& [key, value] : entries.members())
        references.add_named(key, read(value, key));
}

}  // namespace raypick
