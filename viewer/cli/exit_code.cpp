#include "viewer/cli/exit_code.h"

#include "viewer/headless/offscreen_context.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <new>
#include <string>

namespace raypick {
namespace {

int failed(int exit_code, std::string_view message) {
    print_message(message);
    return exit_code;
}

}  // namespace

void print_message(std::string_view message) {
    std::string line = "raypick: ";
    for (const char c : message) {
        const auto byte = static_cast<unsigned char>(c);
        line += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
}

int report_current_exception() {
    try {
        throw;
    } catch (const UsageError& error) {
        return failed(kExitUsage, error.what());
    } catch (const Interrupted& interrupted) {
        return kExitSignalBase + interrupted.signal();
    } catch (const BrokenPipe&) {
        return kExitSignalBase + SIGPIPE;
    } catch (const NoOpenGL& error) {
        return failed(kExitNoOpenGL, error.what());
    } catch (const std::bad_alloc&) {
        return failed(kExitFailed,
                      "out of memory: the scene or the image is too large for this "
                      "machine");
    } catch (const std::exception& error) {
        return failed(kExitFailed, error.what());
    }
}

}  // namespace raypick
