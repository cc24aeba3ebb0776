#include "tests/bench/instruction_sets.h"

namespace raypick::bench {

// The tracer has no code of its own for an instruction set.
bool limit_our_instructions(const std::string&) {
    return false;
}

}  // namespace raypick::bench
