// Where a rendered image goes.
#pragma once

#include "tracer/render/image.h"

#include <filesystem>
#include <string>

namespace raypick {

// A file by its name, or "-": PNG on standard output. What can be known to fail is found when it is
// made, before any time is spent on tracing.
class RenderOutput {
public:
    // Throws UsageError if the ending names no format that we write, FileError if the place can't
    // be written to.
    RenderOutput(const std::string& output, ImageSize size);

    // Throws FileError; a file that was there before is then still there.
    void write(const Image& image) const;

private:
    std::filesystem::path file_;
    bool to_standard_output_;
};

}  // namespace raypick
