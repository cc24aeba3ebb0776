// A file that is written beside its target and renamed when it is whole, so that a failure leaves
// no half file.
#pragma once

#include "tracer/error.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace raypick {

// A name beside the target that no other process uses; removed unless renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::filesystem::path& target)
        : target_(target), path_(target.string() + fmt::format(".{}.part", ::getpid())) {}
    ~TemporaryFile() {
        std::error_code ignored;
        if (!renamed_) std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    // Throws FileError.
    void rename() {
        std::error_code failure;
        std::filesystem::rename(path_, target_, failure);
        if (failure) {
            throw FileError(target_.string(), "can't be written: " + failure.message());
        }
        renamed_ = true;
    }

private:
    std::filesystem::path target_;
    std::filesystem::path path_;
    bool renamed_ = false;
};

}  // namespace raypick
