#include "tests/bench/machine.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <thread>

namespace raypick::bench {

namespace {

// What stands behind "key ... :" in a file of the kernel's; "" if it has no such line.
std::string field(const std::string& file, const std::string& key) {
    std::ifstream in(file);
    std::string line;
    while (std::getline(in, line)) {
        if (line.rfind(key, 0) != 0) continue;
        const std::size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
        return start == std::string::npos ? "" : line.substr(start);
    }
    return "";
}

std::string instruction_sets() {
    std::istringstream flags(field("/proc/cpuinfo", "flags"));
    std::string found;
    std::string flag;
    while (flags >> flag) {
        if (flag == "sse4_2" || flag == "avx2" || flag == "fma" || flag == "avx512f" ||
            flag == "avx512vl") {
            found += " " + flag;
        }
    }
    return found;
}

std::string cache_text() {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", i);
        std::string level;
        std::string kind;
        std::string size;
        std::ifstream(folder + "level") >> level;
        std::ifstream(folder + "type") >> kind;
        std::ifstream(folder + "size") >> size;
        if (level.empty() || kind == "Instruction") continue;
        text += fmt::format(" L{} {}", level, size);
    }
    return text;
}

}  // namespace

std::vector<std::string> describe_machine() {
    return {fmt::format("{}:{}", field("/proc/cpuinfo", "model name"), instruction_sets()),
            fmt::format("{} threads,{}, memory {}", std::thread::hardware_concurrency(),
                        cache_text(), field("/proc/meminfo", "MemTotal")),
#ifdef __clang__
            fmt::format("clang {}", __clang_version__)
#else
            fmt::format("GCC {}", __VERSION__)
#endif
    };
}

}  // namespace raypick::bench
