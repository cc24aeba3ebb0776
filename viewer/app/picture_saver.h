// Writes pictures beside the running window.
#pragma once

#include "tracer/render/image.h"

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>

namespace raypick {

struct SaveResult {
    std::filesystem::path file;
    std::string error;  // "": it was written
};

class PictureSaver {
public:
    // `notify` is called from the working thread when a result is ready.
    explicit PictureSaver(std::function<void()> notify) : notify_(std::move(notify)) {}

    // Begins to write; nothing happens while another picture is being written.
    void save(Image image, const std::filesystem::path& file);
    [[nodiscard]] bool busy() const { return result_.valid(); }
    // The result, once.
    std::optional<SaveResult> take_result();

private:
    std::function<void()> notify_;
    std::future<SaveResult> result_;  // its destructor waits until the file is complete
};

// The first of stem-1.png, stem-2.png, ... in `folder` that does not exist yet.
std::filesystem::path free_picture_name(const std::filesystem::path& folder,
                                        const std::string& stem);

}  // namespace raypick
