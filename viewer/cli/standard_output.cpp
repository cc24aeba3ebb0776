#include "viewer/cli/standard_output.h"

#include "viewer/cli/exit_code.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace raypick {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 16;

// What is left of `text` after one write.
std::string_view write_some(std::string_view text) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written >= 0) return text.substr(static_cast<std::size_t>(written));
    if (errno == EPIPE) throw BrokenPipe();
    if (errno == EAGAIN) {  // someone made the pipe non-blocking
        pollfd ready{STDOUT_FILENO, POLLOUT, 0};
        ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
        throw Error(fmt::format("can't write to standard output: {}", std::strerror(errno)));
    }
    return text;
}

}  // namespace

void StandardOutput::write(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() >= kBufferSize) flush();
}

void StandardOutput::flush() {
    std::string_view rest = buffer_;
    while (!rest.empty())
        rest = write_some(rest);
    buffer_.clear();
}

}  // namespace raypick
