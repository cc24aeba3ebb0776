// Lines from a pipe, a file or a terminal, as many at a time as are there.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

class LineReader {
public:
    static constexpr std::size_t kLongestLine = 4096;

    explicit LineReader(int file_descriptor) : file_descriptor_(file_descriptor) {}

    // Waits until at least one line is there and gives all that are, without their line ends. The
    // last line needs none. Empty at the end. The views are good until the next call. Of a line
    // longer than kLongestLine only that much is given, so that memory stays bounded. Throws Error
    // if it can't be read.
    std::vector<std::string_view> read();

private:
    bool fill();
    std::vector<std::string_view> take_lines();
    void take_long_line(std::vector<std::string_view>& lines);

    int file_descriptor_;
    std::string buffer_;
    std::size_t taken_ = 0;      // bytes of the buffer that were given out
    bool in_long_line_ = false;  // its beginning was given out; skip to its end
    bool ended_ = false;
};

}  // namespace raypick
