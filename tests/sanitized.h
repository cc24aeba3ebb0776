// For tests of memory, and for those that a sanitizer would make take minutes.
#pragma once

namespace raypick {

// Whether the build's libraries and program are watched by a sanitizer, which takes many times as
// long and holds memory of its own.
bool is_sanitized();

}  // namespace raypick
