// The machine that a run's numbers belong to.
#pragma once

#include <string>
#include <vector>

namespace raypick::bench {

// A few lines: processor, its instruction sets that matter here, cores, caches, memory, compiler.
std::vector<std::string> describe_machine();

}  // namespace raypick::bench
