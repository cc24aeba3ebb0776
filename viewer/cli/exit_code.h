// How the program ends: exit codes, the messages that go with them, and what is thrown for them.
#pragma once

#include "tracer/error.h"

#include <string_view>

namespace raypick {

inline constexpr int kExitOk = 0;            // also "nothing was hit": that is a result
inline constexpr int kExitFailed = 1;        // unreadable file, render failed
inline constexpr int kExitUsage = 2;         // wrong options, a pixel outside the image
inline constexpr int kExitNoOpenGL = 77;     // no off-screen OpenGL; CTest's skip code
inline constexpr int kExitSignalBase = 128;  // + the signal's number

// The person asked for something that makes no sense. Exit code 2.
class UsageError : public Error {
public:
    using Error::Error;
};

// A signal asked the program to stop, and it did so in good order. Exit code 128 + signal.
class Interrupted : public Error {
public:
    explicit Interrupted(int signal) : Error("interrupted"), signal_(signal) {}

    [[nodiscard]] int signal() const { return signal_; }

private:
    int signal_;
};

// Nobody reads standard output any more (as in `raypick ... | head`). The program ends quietly.
class BrokenPipe : public Error {
public:
    BrokenPipe() : Error("nobody reads standard output any more") {}
};

// "raypick: MESSAGE" as one line on standard error. Control characters become "?", so that a file's
// name can't break the line or steer the terminal.
void print_message(std::string_view message);

// The exit code for the exception being handled; prints its message if it has one to show. Call it
// in a catch block.
int report_current_exception();

}  // namespace raypick
