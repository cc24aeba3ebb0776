#include "program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace raypick {
namespace {

double now() {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(time).count();
}

void must(bool good, const char* what) {
    if (!good) throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

bool names_display(const char* variable) {
    const std::string text = variable;
    return text.rfind("DISPLAY=", 0) == 0 || text.rfind("WAYLAND_DISPLAY=", 0) == 0;
}

// `display` as in "DISPLAY=:1", or empty; it must outlive the result.
std::vector<char*> environment_with(std::string& display) {
    std::vector<char*> variables;
    if (!display.empty()) variables.push_back(display.data());
    for (char** variable = environ; *variable != nullptr; ++variable) {
        if (!names_display(*variable)) variables.push_back(*variable);
    }
    variables.push_back(nullptr);
    return variables;
}

struct Pipe {
    int read_end = -1;
    int write_end = -1;
};

// Its ends are not inherited by other programs that the test starts.
Pipe make_pipe() {
    int ends[2] = {-1, -1};
    must(::pipe2(ends, O_CLOEXEC) == 0, "pipe");
    return {ends[0], ends[1]};
}

void close_once(int& descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "raypick-XXXXXX").string();
    must(::mkdtemp(pattern.data()) != nullptr, "mkdtemp");
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const std::string& name,
                                             const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
}

std::vector<std::string> TemporaryFolder::names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_file(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const ProgramFiles& files,
                               bool input_is_pipe)
    : error_file_(folder_ / "standard-error"), started_(now()) {
    Pipe input;
    Pipe output;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (input_is_pipe) {
        input = make_pipe();
        posix_spawn_file_actions_adddup2(&actions, input.read_end, STDIN_FILENO);
    } else {
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, files.in.c_str(), O_RDONLY, 0);
    }
    if (files.out.empty()) {
        output = make_pipe();
        posix_spawn_file_actions_adddup2(&actions, output.write_end, STDOUT_FILENO);
    } else {
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, files.out.c_str(),
                                         O_WRONLY | O_CREAT | O_TRUNC, 0644);
    }
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error_file_.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (!files.folder.empty()) {
        posix_spawn_file_actions_addchdir_np(&actions, files.folder.c_str());
    }

    std::vector<std::string> words = {RAYPICK_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    std::string display = files.display.empty() ? "" : "DISPLAY=" + files.display;
    const int failure = ::posix_spawn(&process_, RAYPICK_PROGRAM, &actions, nullptr, argv.data(),
                                      environment_with(display).data());
    posix_spawn_file_actions_destroy(&actions);
    close_once(input.read_end);
    close_once(output.write_end);
    input_ = input.write_end;
    output_ = output.read_end;
    errno = failure;
    must(failure == 0, "can't start " RAYPICK_PROGRAM);
}

RunningProgram::~RunningProgram() {
    close_input();
    close_output();
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
}

void RunningProgram::write(const std::string& text) const {
    must(::write(input_, text.data(), text.size()) == static_cast<ssize_t>(text.size()), "write");
}

void RunningProgram::close_input() {
    close_once(input_);
}

void RunningProgram::close_output() {
    close_once(output_);
}

// Adds what comes next to the buffer; closes the output at its end.
void RunningProgram::drain(double timeout_seconds) {
    pollfd ready{output_, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(1e3 * timeout_seconds)) <= 0) return;
    char chunk[65536];
    const ssize_t count = ::read(output_, chunk, sizeof chunk);
    if (count <= 0) return close_output();
    buffer_.append(chunk, static_cast<std::size_t>(count));
}

std::optional<std::string> RunningProgram::read_line(double timeout_seconds) {
    const double end = now() + timeout_seconds;
    while (buffer_.find('\n') == std::string::npos) {
        if (output_ < 0 || now() > end) return std::nullopt;
        drain(0.1);
    }
    const std::size_t line_end = buffer_.find('\n');
    std::string line = buffer_.substr(0, line_end);
    buffer_.erase(0, line_end + 1);
    return line;
}

bool RunningProgram::wait_for_error_text(const std::string& text, double timeout_seconds) {
    const double end = now() + timeout_seconds;
    while (read_file(error_file_).find(text) == std::string::npos) {
        if (now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

void RunningProgram::send(int signal) const {
    ::kill(process_, signal);
}

ProgramResult RunningProgram::wait(double timeout_seconds) {
    const double end = now() + timeout_seconds;
    close_input();
    while (output_ >= 0 && now() < end)
        drain(0.1);
    int status = 0;
    rusage usage{};
    pid_t ended = 0;
    while ((ended = ::wait4(process_, &status, WNOHANG, &usage)) == 0 && now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ProgramResult result;
    result.seconds = now() - started_;
    result.out = std::move(buffer_);
    result.err = read_file(error_file_);
    result.peak_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    if (ended == process_) {
        process_ = -1;
        if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    }
    return result;
}

ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramFiles& files) {
    return RunningProgram(arguments, files).wait();
}

ProgramResult run_program_on(const std::vector<std::string>& arguments, const std::string& input) {
    const TemporaryFolder folder;
    ProgramFiles files;
    files.in = folder.write("input", input);
    return run_program(arguments, files);
}

}  // namespace raypick
