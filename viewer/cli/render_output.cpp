#include "viewer/cli/render_output.h"

#include "tracer/render/image_files.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/standard_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace raypick {
namespace {

void check_writable(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    const auto fail = [&file](const std::string& why) { throw FileError(file.string(), why); };
    std::error_code ignored;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored)) {
        fail("can't be written: there is no folder " + folder.string());
    }
    if (fs::is_directory(file, ignored)) fail("can't be written: it is a folder");
    if (fs::exists(file, ignored) && ::access(file.c_str(), W_OK) != 0) {
        fail(std::string("can't be written: ") + std::strerror(errno));
    }
    // Permissions don't tell all (read-only and special file systems, quotas): try it.
    const fs::path probe = file.string() + fmt::format(".{}.probe", ::getpid());
    const int descriptor = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0) fail(std::string("can't be written: ") + std::strerror(errno));
    ::close(descriptor);
    fs::remove(probe, ignored);
}

}  // namespace

RenderOutput::RenderOutput(const std::string& output, ImageSize size)
    : file_(output), to_standard_output_(output == "-") {
    const std::string problem = unsupported_image(to_standard_output_ ? "-.png" : file_, size);
    if (!problem.empty()) throw UsageError("--output=" + output + ": " + problem);
    if (to_standard_output_) return;
    check_writable(file_);
}

void RenderOutput::write(const Image& image) const {
    if (!to_standard_output_) return write_image(image, file_);
    const std::vector<std::uint8_t> bytes = png_bytes(image);
    StandardOutput standard_output;
    standard_output.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    standard_output.flush();
}

}  // namespace raypick
