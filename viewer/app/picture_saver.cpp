#include "viewer/app/picture_saver.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

namespace raypick {

void PictureSaver::save(Image image, const std::filesystem::path& file) {
    if (busy()) return;
    result_ = std::async(std::launch::async, [image = std::move(image), file, notify = notify_] {
        SaveResult result{file, ""};
        try {
            write_image(image, file);
        } catch (const std::exception& error) {
            result.error = error.what();
        }
        notify();
        return result;
    });
}

std::optional<SaveResult> PictureSaver::take_result() {
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
