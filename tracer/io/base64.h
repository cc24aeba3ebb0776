// Base64 (RFC 4648), as in data URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace raypick {

// Nothing if `text` is not base64. Padding may be missing.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace raypick
