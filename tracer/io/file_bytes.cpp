#include "tracer/io/file_bytes.h"

#include "tracer/error.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <system_error>
#include <utility>

namespace raypick {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail_with_errno(const std::filesystem::path& file, const std::string& complaint) {
    throw FileError(file.string(), complaint + ": " + std::generic_category().message(errno));
}

// Opening a folder or a pipe would succeed and then fail or wait in ways that nobody understands.
void check_regular(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        throw FileError(file.string(), "no such file");
    }
    if (error) throw FileError(file.string(), "cannot be opened: " + error.message());
    if (std::filesystem::is_directory(status)) throw FileError(file.string(), "is a folder");
    if (!std::filesystem::is_regular_file(status)) {
        throw FileError(file.string(), "is not a regular file");
    }
}

// Length of the UTF-8 character that `bytes` begin with; 0 if they begin with none.
std::size_t utf8_length(std::string_view bytes) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    std::size_t length = 0;
    if (byte(0) < 0x80) return 1;
    if (byte(0) >= 0xc2 && byte(0) <= 0xdf) length = 2;
    if (byte(0) >= 0xe0 && byte(0) <= 0xef) length = 3;
    if (byte(0) >= 0xf0 && byte(0) <= 0xf4) length = 4;
    if (length == 0 || bytes.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0u) != 0x80u) return 0;
    }
    // Overlong forms, surrogates and what lies beyond Unicode.
    if (byte(0) == 0xe0 && byte(1) < 0xa0) return 0;
    if (byte(0) == 0xed && byte(1) > 0x9f) return 0;
    if (byte(0) == 0xf0 && byte(1) < 0x90) return 0;
    if (byte(0) == 0xf4 && byte(1) > 0x8f) return 0;
    return length;
}

bool is_utf8(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::size_t length = utf8_length(bytes);
        if (length == 0) return false;
        bytes.remove_prefix(length);
    }
    return true;
}

}  // namespace

FileBytes read_file(const std::filesystem::path& file, std::size_t most) {
    check_regular(file);
    const File handle(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!handle) fail_with_errno(file, "cannot be opened");
    std::error_code error;
    const std::uintmax_t file_size = std::filesystem::file_size(file, error);
    if (error) throw FileError(file.string(), "cannot be read: " + error.message());
    if (file_size == 0) throw FileError(file.string(), "is empty");
    const auto size = static_cast<std::size_t>(std::min<std::uintmax_t>(file_size, most));
    auto data = std::make_unique_for_overwrite<char[]>(size);
    const std::size_t read = std::fread(data.get(), 1, size, handle.get());
    if (std::ferror(handle.get()) != 0) fail_with_errno(file, "cannot be read");
    return {std::move(data), read};
}

FileText::FileText(const std::filesystem::path& file)
    : bytes_(read_file(file)), view_(bytes_.view()) {
    if (view_.substr(0, 2) == "\xff\xfe" || view_.substr(0, 2) == "\xfe\xff") {
        throw FileError(file.string(), "byte 0: UTF-16 text is not read: save it as UTF-8");
    }
    if (view_.substr(0, 3) == "\xef\xbb\xbf") view_.remove_prefix(3);
    const bool old_mac =
        view_.find('\n') == std::string_view::npos && view_.find('\r') != std::string_view::npos;
    if (old_mac) {
        old_mac_ = view_;
        std::replace(old_mac_.begin(), old_mac_.end(), '\r', '\n');
        view_ = old_mac_;
    }
}

std::string clean_name(std::string_view bytes) {
    const bool latin1 = !is_utf8(bytes);
    std::string name;
    name.reserve(bytes.size());
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) {
            name += '?';
        } else if (latin1 && byte >= 0x80) {
            name += static_cast<char>(0xc0u | (byte >> 6u));
            name += static_cast<char>(0x80u | (byte & 0x3fu));
        } else {
            name += c;
        }
    }
    return name;
}

}  // namespace raypick
