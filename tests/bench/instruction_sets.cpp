#include "tests/bench/instruction_sets.h"

#include "tracer/accel/trace_rays.h"
#include "tracer/error.h"

#include <algorithm>
#include <cctype>

namespace raypick::bench {

// Embree says avx2 and sse4.2, Highway AVX2 and SSE4.
bool limit_our_instructions(const std::string& isa) {
    std::string name = isa.substr(0, isa.find('.'));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (name == "AVX512") name = "AVX3";
    try {
        use_instruction_set(name);
    } catch (const Error&) {
        return false;
    }
    return true;
}

}  // namespace raypick::bench
