#include "tests/bench/command.h"

#include "tests/bench/measure.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>

namespace raypick::bench {

CommandResult run_shell(const std::string& command) {
    CommandResult result;
    result.seconds = seconds_of([&] {
        std::FILE* pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
        if (pipe == nullptr) return;
        std::array<char, 4096> chunk{};
        std::size_t count = 0;
        while ((count = std::fread(chunk.data(), 1, chunk.size(), pipe)) > 0)
            result.out.append(chunk.data(), count);
        const int status = ::pclose(pipe);
        if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
    });
    return result;
}

bool has_program(const std::string& name) {
    return run_shell("command -v " + name).exit_code == 0;
}

}  // namespace raypick::bench
