// A file's content, read in one go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace raypick {

class FileBytes {
public:
    FileBytes() = default;
    FileBytes(std::unique_ptr<char[]> data, std::size_t size)
        : data_(std::move(data)), size_(size) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::string_view view() const { return {data_.get(), size_}; }

private:
    std::unique_ptr<char[]> data_;
    std::size_t size_ = 0;
};

// The first `most` bytes of a file. Throws FileError if it is missing, unreadable, empty, a folder
// or no regular file.
FileBytes read_file(const std::filesystem::path& file, std::size_t most = SIZE_MAX);

// The file's text. Throws FileError also on UTF-16; skips a UTF-8 byte order mark and turns the
// line ends of old Macs (CR alone) into LF.
class FileText {
public:
    explicit FileText(const std::filesystem::path& file);

    [[nodiscard]] std::string_view view() const { return view_; }

private:
    FileBytes bytes_;
    std::string old_mac_;
    std::string_view view_;
};

// A name from a file as valid UTF-8 that fits on one line: bytes that are no UTF-8 are taken for
// Latin-1, control characters become '?'.
std::string clean_name(std::string_view bytes);

}  // namespace raypick
