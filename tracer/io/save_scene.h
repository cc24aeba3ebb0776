// Writes a scene as one of our JSON scene files, with everything in it.
#pragma once

#include "tracer/scene/scene.h"

#include <atomic>
#include <filesystem>
#include <stop_token>

namespace raypick {

struct SaveOptions {
    std::stop_token stop;                    // saving then throws Cancelled
    std::atomic<float>* progress = nullptr;  // 0..1, if wanted
};

// Meshes, sets, textures and skies are embedded, so that the file needs no other; loading it gives
// a scene whose traced images are the same bit for bit, with the same ids and names (of a session
// that starts with id 0). Written beside the target and renamed, so that a failure leaves no half
// file. Throws FileError, Cancelled, or Error if the scene does not pass check_scene.
void save_scene(const Scene& scene, const std::filesystem::path& file,
                const SaveOptions& options = {});

}  // namespace raypick
