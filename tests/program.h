// Runs the real program raypick, as a shell would, for tests.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace raypick {

struct ProgramResult {
    int exit_code = -1;  // -1: killed by `signal`, or (signal 0) it did not end in time
    int signal = 0;
    std::string out;
    std::string err;
    double seconds = 0.0;
    std::size_t peak_bytes = 0;  // most memory it ever had
};

// A folder that is there while this is.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
        return path_ / name;
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    // Writes a file into it.
    [[nodiscard]] std::filesystem::path write(const std::string& name,
                                              const std::string& text) const;
    // Names of what is in it, sorted.
    [[nodiscard]] std::vector<std::string> names() const;

private:
    std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& file);

// Where the program's input comes from and its output goes to.
struct ProgramFiles {
    std::filesystem::path in = "/dev/null";
    std::filesystem::path out;       // empty: a pipe that the test reads
    std::string display{};           // X display; empty: none
    std::filesystem::path folder{};  // to run in; empty: the test's own
};

// The program with its arguments, running without a display (no DISPLAY, no WAYLAND_DISPLAY) unless
// one is given.
class RunningProgram {
public:
    // With a pipe to its standard input; from there on as ProgramFiles says.
    RunningProgram(const std::vector<std::string>& arguments, const ProgramFiles& files,
                   bool input_is_pipe = false);
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    void write(const std::string& text) const;
    void close_input();
    // The next line of its output; nothing if none came in time or it ended.
    std::optional<std::string> read_line(double timeout_seconds = 60.0);
    void close_output();
    // True once its standard error holds this text.
    bool wait_for_error_text(const std::string& text, double timeout_seconds = 60.0);
    void send(int signal) const;
    // Collects what is left of its output and waits for its end; kills it if that takes too long.
    ProgramResult wait(double timeout_seconds = 120.0);

private:
    void drain(double timeout_seconds);

    TemporaryFolder folder_;
    std::filesystem::path error_file_;
    pid_t process_ = -1;
    int input_ = -1;
    int output_ = -1;
    std::string buffer_;
    double started_ = 0.0;
};

ProgramResult run_program(const std::vector<std::string>& arguments,
                          const ProgramFiles& files = {});
// With this text on its standard input.
ProgramResult run_program_on(const std::vector<std::string>& arguments, const std::string& input);

}  // namespace raypick
