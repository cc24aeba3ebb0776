#include "viewer/cli/line_reader.h"

#include "tracer/error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace raypick {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;

std::string_view without_return(std::string_view line) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line.substr(0, LineReader::kLongestLine);
}

}  // namespace

std::vector<std::string_view> LineReader::read() {
    std::vector<std::string_view> lines;
    while (lines.empty() && !ended_) {
        buffer_.erase(0, taken_);
        taken_ = 0;
        if (!fill()) {
            ended_ = true;
            if (!buffer_.empty() && !in_long_line_) lines.push_back(without_return(buffer_));
            break;
        }
        lines = take_lines();
    }
    return lines;
}

// Appends what is there to read; false at the end.
bool LineReader::fill() {
    const std::size_t before = buffer_.size();
    buffer_.resize(before + kChunk);
    ssize_t count = -1;
    do {
        count = ::read(file_descriptor_, buffer_.data() + before, kChunk);
    } while (count < 0 && errno == EINTR);
    buffer_.resize(before + static_cast<std::size_t>(count < 0 ? 0 : count));
    if (count < 0) throw Error(fmt::format("can't read standard input: {}", std::strerror(errno)));
    return count > 0;
}

std::vector<std::string_view> LineReader::take_lines() {
    std::vector<std::string_view> lines;
    const std::string_view text = buffer_;
    for (std::size_t end = text.find('\n'); end != std::string_view::npos;
         end = text.find('\n', taken_)) {
        if (!in_long_line_) lines.push_back(without_return(text.substr(taken_, end - taken_)));
        in_long_line_ = false;
        taken_ = end + 1;
    }
    take_long_line(lines);
    return lines;
}

// Gives out the beginning of a line that is too long to wait for its end.
void LineReader::take_long_line(std::vector<std::string_view>& lines) {
    const std::string_view rest = std::string_view(buffer_).substr(taken_);
    if (!in_long_line_ && rest.size() <= kLongestLine) return;
    if (!in_long_line_) lines.push_back(rest.substr(0, kLongestLine));
    in_long_line_ = true;
    taken_ = buffer_.size();
}

}  // namespace raypick
