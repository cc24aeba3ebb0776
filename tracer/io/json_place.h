// Where the values of a JSON text stand in it, found by reading it once more: for messages, which
// are rare, so that reading itself has nothing to remember.
#pragma once

#include <cstddef>
#include <string_view>

namespace raypick {

// The line, from 1, of the value that a JSON pointer (RFC 6901) leads to: that of its key, if it
// has one. Of equal keys in one object the last one counts. Where the pointer leads nowhere: of the
// last value on the way. `text` is JSON with comments; it may be broken behind the value.
std::size_t json_line(std::string_view text, std::string_view pointer);

}  // namespace raypick
