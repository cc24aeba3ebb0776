// Numbers, points and colours of a scene file. Each reader throws FileError that names the place of
// what is wrong.
#pragma once

#include "tracer/io/json_value.h"
#include "tracer/io/mesh_build.h"
#include "tracer/scene/limits.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace raypick {

using Keys = std::vector<std::string_view>;

inline constexpr NumberRule kCoordinate{-kLargestCoordinate, kLargestCoordinate, true,
                                        "a number between -1e18 and 1e18"};
inline constexpr NumberRule kPositive{kSmallestPositive, kLargestCoordinate, true,
                                      "a positive number"};
inline constexpr NumberRule kNotNegative{0.0, kMostLight, true, "a number from 0 to 1e18"};
inline constexpr NumberRule kSurfaceColour{0.0, kMostSurfaceColour, true, "a number from 0 to 1e6"};
inline constexpr NumberRule kBounce{0.0, kMostBounce, true, "a number from 0 to 2"};
inline constexpr NumberRule kFraction{0.0, 1.0, true, "a number from 0 to 1"};

// Calls read(value) if there is such a key.
template <typename Read>
void if_present(const JsonValue& object, std::string_view key, const Read& read) {
    if (const std::optional<JsonValue> value = object.find(key)) read(*value);
}

float read_float(const JsonValue& value, const NumberRule& rule);
glm::dvec3 read_point(const JsonValue& value);
// Not [0, 0, 0].
glm::dvec3 read_direction(const JsonValue& value);
// [r, g, b] or one number for all three, linear. The rule is for each.
glm::vec3 read_colour(const JsonValue& value, const NumberRule& rule = kNotNegative);

// The words of an enumeration, in the order of its values.
template <typename Enum>
Enum read_word(const JsonValue& value, const Keys& words) {
    const std::string word = value.one_of(words);
    std::size_t i = 0;
    while (words[i] != word)
        ++i;
    return static_cast<Enum>(i);
}

}  // namespace raypick
