// The one exception type that crosses our library boundaries.
#pragma once

#include <stdexcept>
#include <string>

namespace raypick {

// Bad input or a failed operation, worded for the person who caused it: what, where, what to do.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// A file that can't be read: `file` and the complaint are kept apart so that the command line can
// print "raypick: FILE: complaint". The complaint names the place (line, JSON path or byte).
class FileError : public Error {
public:
    FileError(std::string file, const std::string& complaint)
        : Error(file + ": " + complaint), file_(std::move(file)) {}

    [[nodiscard]] const std::string& file() const { return file_; }

private:
    std::string file_;
};

// The caller asked to stop (a stop_token); nothing is wrong.
class Cancelled : public Error {
public:
    Cancelled() : Error("cancelled") {}
};

}  // namespace raypick
