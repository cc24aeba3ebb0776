#include "viewer/cli/commands.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/options.h"

int main(int argc, char** argv) {
    try {
        const auto command = raypick::parse_command_line({argv + 1, argv + argc});
        return command ? raypick::run(*command) : raypick::kExitOk;
    } catch (...) {
        return raypick::report_current_exception();
    }
}
