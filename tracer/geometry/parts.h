// Checks what meshes and sets have in common: their parts.
#pragma once

#include "tracer/geometry/shapes.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace raypick {

// Throws Error unless the parts follow each other and cover `count` primitives, or there are none.
// For the message: the `kind` ("mesh") and name of what has parts, and what these hold
// ("triangle").
void check_parts(std::string_view kind, std::string_view name, std::string_view primitive,
                 std::span<const Part> parts, std::size_t count);

}  // namespace raypick
