// Standard output, buffered.
#pragma once

#include <string>
#include <string_view>

namespace raypick {

// Collects text and writes it in large pieces. What is not flushed when it goes is lost, so that a
// failing command prints nothing half.
class StandardOutput {
public:
    // Throws BrokenPipe if nobody reads any more, Error if it can't be written.
    void write(std::string_view text);
    void flush();

private:
    std::string buffer_;
};

}  // namespace raypick
