// Writes pictures and scenes beside the running window.
#pragma once

#include "tracer/render/image.h"
#include "tracer/scene/scene.h"

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace raypick {

enum class SaveKind { picture, scene };

struct SaveResult {
    SaveKind kind = SaveKind::picture;
    std::filesystem::path file;
    std::string error;  // "": it was written
};

class FileSaver {
public:
    // `notify` is called from the working thread when a result is ready.
    explicit FileSaver(std::function<void()> notify) : notify_(std::move(notify)) {}

    // Begin to write; nothing happens while another file is being written.
    void save(Image image, const std::filesystem::path& file);
    // As save_scene writes it.
    void save(std::shared_ptr<const Scene> scene, const std::filesystem::path& file);
    [[nodiscard]] bool busy() const { return result_.valid(); }
    // The result, once.
    std::optional<SaveResult> take_result();

private:
    void start(SaveKind kind, const std::filesystem::path& file, std::function<void()> write);

    std::function<void()> notify_;
    std::future<SaveResult> result_;  // its destructor waits until the file is complete
};

// The first of stem-1.png, stem-2.png, ... in `folder` that does not exist yet.
std::filesystem::path free_picture_name(const std::filesystem::path& folder,
                                        const std::string& stem);

}  // namespace raypick
