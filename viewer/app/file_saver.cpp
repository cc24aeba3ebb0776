#include "viewer/app/file_saver.h"

#include "tracer/io/save_scene.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

namespace raypick {

void FileSaver::save(Image image, const std::filesystem::path& file) {
    start(SaveKind::picture, file, [image = std::move(image), file] { write_image(image, file); });
}

void FileSaver::save(std::shared_ptr<const Scene> scene, const std::filesystem::path& file) {
    start(SaveKind::scene, file, [scene = std::move(scene), file] { save_scene(*scene, file); });
}

void FileSaver::start(SaveKind kind, const std::filesystem::path& file,
                      std::function<void()> write) {
    if (busy()) return;
    result_ =
        std::async(std::launch::async, [kind, file, write = std::move(write), notify = notify_] {
            SaveResult result{kind, file, ""};
            try {
                write();
            } catch (const std::exception& error) {
                result.error = error.what();
            }
            notify();
            return result;
        });
}

std::optional<SaveResult> FileSaver::take_result() {
    if (!busy() || result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return std::nullopt;
    }
    return result_.get();
}

std::filesystem::path free_picture_name(const std::filesystem::path& folder,
                                        const std::string& stem) {
    std::filesystem::path file;
    std::error_code error;  // a folder that can't be looked into holds no such file for us
    int number = 1;
    do {
        file = folder / fmt::format("{}-{}.png", stem, number++);
    } while (std::filesystem::exists(file, error));
    return file;
}

}  // namespace raypick
