// Linked into every test: with RAYPICK_INSTRUCTION_SET=NAME in the environment its rays run on that
// one, unless the test chooses itself.
#include "tracer/accel/trace_rays.h"

#include <cstdlib>

namespace raypick {
namespace {

bool choose() {
    const char* name = std::getenv("RAYPICK_INSTRUCTION_SET");
    if (name != nullptr) use_instruction_set(name);  // an unknown one ends the test by its message
    return name != nullptr;
}

[[maybe_unused]] const bool chosen = choose();

}  // namespace
}  // namespace raypick
