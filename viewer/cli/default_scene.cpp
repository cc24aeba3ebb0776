#include "viewer/cli/default_scene.h"

#include <system_error>

namespace raypick {

std::filesystem::path default_scene() {
    namespace fs = std::filesystem;
    std::error_code ignored;
    // Relative to the program, so that an installed tree can be moved.
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    const fs::path installed =
        program.parent_path().parent_path() / RAYPICK_DATA_FOLDER / "default.json";
    for (const fs::path& file : {installed, fs::path(RAYPICK_SOURCE_ASSETS "/default.json")}) {
        if (fs::exists(file, ignored)) return file;
    }
    return {};
}

}  // namespace raypick
