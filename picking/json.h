// Writing JSON straight into a string, fast enough for millions of lines.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace raypick {

// Each appends one JSON value to `out`. Numbers are the shortest text that reads back as the same
// value; NaN and infinities, which JSON doesn't have, become null.
void append_json(std::string& out, float value);
void append_json(std::string& out, double value);
void append_json(std::string& out, std::int64_t value);
void append_json(std::string& out, const glm::vec2& value);
void append_json(std::string& out, const glm::vec3& value);
void append_json(std::string& out, const glm::dvec3& value);
// Quoted and escaped. What is not valid UTF-8 becomes U+FFFD, byte by byte.
void append_json(std::string& out, std::string_view text);

}  // namespace raypick
