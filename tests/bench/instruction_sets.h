// Runs that leave the newest instructions alone.
#pragma once

#include <string>

namespace raypick::bench {

// Limits the tracer to an instruction set ("avx2") for the rest of the process; false if it has no
// such choice. Before the first tree is built.
bool limit_our_instructions(const std::string& isa);

}  // namespace raypick::bench
