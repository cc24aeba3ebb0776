// Base64 (RFC 4648), as in data URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace raypick {

// Appends the base64 of `bytes`, padded. What is written in pieces must be in pieces of multiples
// of three bytes, but for the last.
void append_base64(std::string& text, std::string_view bytes);

// Nothing if `text` is not base64. Padding may be missing.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace raypick
