// Members of JSON objects as scene files have them.
#pragma once

#include "tracer/io/embedded_array.h"
#include "tracer/io/json_writer.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace raypick {

inline constexpr bool kOneLine = true;

inline void write_member(JsonWriter& json, std::string_view key, std::string_view value) {
    json.key(key);
    json.text(value);
}

inline void write_member(JsonWriter& json, std::string_view key, const char* value) {
    write_member(json, key, std::string_view(value));
}

inline void write_member(JsonWriter& json, std::string_view key, std::same_as<bool> auto value) {
    json.key(key);
    json.truth(value);
}

inline void write_member(JsonWriter& json, std::string_view key, std::floating_point auto value) {
    json.key(key);
    json.number(value);
}

inline void write_member(JsonWriter& json, std::string_view key, std::uint32_t value) {
    json.key(key);
    json.whole_number(value);
}

// Numbers of a vector, on one line.
template <int N, typename Number>
void write_member(JsonWriter& json, std::string_view key, const glm::vec<N, Number>& value) {
    json.key(key);
    json.open_array(kOneLine);
    for (int i = 0; i < N; ++i)
        json.number(value[i]);
    json.close_array();
}

// `Element` consists of numbers of type Number and nothing else.
template <typename Number, typename Element>
void write_array(JsonWriter& json, std::string_view key, std::span<const Element> elements) {
    static_assert(std::is_trivially_copyable_v<Element> && sizeof(Element) % sizeof(Number) == 0);
    json.key(key);
    const char* const bytes = reinterpret_cast<const char*>(elements.data());
    if constexpr (std::endian::native == std::endian::big && sizeof(Number) > 1) {
        std::string swapped(bytes, elements.size_bytes());
        swap_if_big_endian(swapped, sizeof(Number));
        json.base64(swapped);
    } else {
        json.base64({bytes, elements.size_bytes()});
    }
}

}  // namespace raypick
