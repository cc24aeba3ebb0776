// Runs other programs.
#pragma once

#include <cstddef>
#include <string>

namespace raypick::bench {

struct CommandResult {
    int exit_code = -1;  // -1: it was killed or did not start
    std::string out;     // standard output and standard error
    double seconds = 0.0;
};

// By /bin/sh.
CommandResult run_shell(const std::string& command);

// True if the shell finds this program.
bool has_program(const std::string& name);

}  // namespace raypick::bench
